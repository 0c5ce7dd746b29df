// Test certificates: a certificate authority and the certificates that it signs.
#pragma once

#include <openssl/evp.h>
#include <openssl/x509.h>

#include <chrono>
#include <memory>
#include <string>

namespace axisgate {

// A certificate authority for tests. Throws std::runtime_error if OpenSSL or the disk fails.
class Authority {
 public:
  // Loads FOLDER/NAME.crt and FOLDER/NAME.key, or creates them if they do not exist.
  Authority(const std::string& folder, const std::string& name);

  // Writes FOLDER/NAME.crt and FOLDER/NAME.key; each file is replaced as a whole. The certificate is valid for a daemon
  // at localhost, 127.0.0.1 and 192.0.2.1 (an address for documentation and tests, RFC 5737), or for a caller called
  // `name`.
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
