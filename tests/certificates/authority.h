// Certificates for tests: an authority, and what it signs.
#pragma once

#include <openssl/evp.h>
#include <openssl/x509.h>

#include <chrono>
#include <memory>
#include <string>

namespace axisgate {

// Throws std::runtime_error where OpenSSL or the disk does not do its part.
class Authority {
 public:
  // Kept in FOLDER/NAME.crt and FOLDER/NAME.key, and found there again.
  Authority(const std::string& folder, const std::string& name);

  // Writes FOLDER/NAME.crt and FOLDER/NAME.key, or replaces them, each as a whole: for a daemon at localhost,
  // 127.0.0.1 and 192.0.2.1, which is for documentation and tests (RFC 5737), or a caller of that name.
  void issue(const std::string& name, std::chrono::hours valid = std::chrono::hours(90 * 24)) const;

 private:
  struct Free {
    void operator()(X509* certificate) const { X509_free(certificate); }
    void operator()(EVP_PKEY* key) const { EVP_PKEY_free(key); }
  };
  using Certificate = std::unique_ptr<X509, Free>;
  using Key = std::unique_ptr<EVP_PKEY, Free>;

  static Certificate sign(const std::string& name, EVP_PKEY* key, X509* issuer, EVP_PKEY* issuer_key,
                          std::chrono::hours valid);
  void write(const std::string& name, X509* certificate, EVP_PKEY* key) const;

  const std::string folder_;
  Certificate certificate_;
  Key key_;
};

}  // namespace axisgate
