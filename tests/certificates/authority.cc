#include "tests/certificates/authority.h"

#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

namespace axisgate {
namespace {

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

void expect(bool done, const char* what) {
  if (!done) throw std::runtime_error(std::string("certificates: ") + what);
}

void add_extension(X509* certificate, X509* issuer, int kind, const char* value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, &context, kind, value);
  expect(extension != nullptr && X509_add_ext(certificate, extension, -1) == 1, value);
  X509_EXTENSION_free(extension);
}

}  // namespace

Authority::Authority(const std::string& folder, const std::string& name) : folder_(folder) {
  const std::string path = folder_ + "/" + name;
  const File key(std::fopen((path + ".key").c_str(), "re"));
  const File certificate(std::fopen((path + ".crt").c_str(), "re"));
  if (key && certificate) {
    key_.reset(PEM_read_PrivateKey(key.get(), nullptr, nullptr, nullptr));
    certificate_.reset(PEM_read_X509(certificate.get(), nullptr, nullptr, nullptr));
    return;
  }
  key_.reset(EVP_EC_gen("P-256"));
  certificate_ = sign(name, key_.get(), nullptr, key_.get(), std::chrono::hours(24));
  write(name, certificate_.get(), key_.get());
}

void Authority::issue(const std::string& name, std::chrono::hours valid) const {
  const Key key(EVP_EC_gen("P-256"));
  write(name, sign(name, key.get(), certificate_.get(), key_.get(), valid).get(), key.get());
}

Authority::Certificate Authority::sign(const std::string& name, EVP_PKEY* key, X509* issuer, EVP_PKEY* issuer_key,
                                       std::chrono::hours valid) {
  Certificate made(X509_new());
  X509_set_version(made.get(), X509_VERSION_3);
  std::uint32_t serial = 0;
  RAND_bytes(reinterpret_cast<unsigned char*>(&serial), sizeof(serial));
  ASN1_INTEGER_set_uint64(X509_get_serialNumber(made.get()), serial);
  // Validity begins an hour ago because the clocks of two machines can differ.
  X509_gmtime_adj(X509_getm_notBefore(made.get()), -3600);
  X509_gmtime_adj(X509_getm_notAfter(made.get()), std::chrono::seconds(valid).count());
  X509_set_pubkey(made.get(), key);
  X509_NAME_add_entry_by_txt(X509_get_subject_name(made.get()), "CN", MBSTRING_UTF8,
                             reinterpret_cast<const unsigned char*>(name.c_str()), -1, -1, 0);
  X509* const signed_by = issuer == nullptr ? made.get() : issuer;
  X509_set_issuer_name(made.get(), X509_get_subject_name(signed_by));
  if (issuer == nullptr) {
    add_extension(made.get(), signed_by, NID_basic_constraints, "critical,CA:TRUE");
  } else {
    add_extension(made.get(), signed_by, NID_subject_alt_name, "DNS:localhost,IP:127.0.0.1,IP:192.0.2.1");
  }
  expect(X509_sign(made.get(), issuer_key, EVP_sha256()) > 0, "signing");
  return made;
}

void Authority::write(const std::string& name, X509* certificate, EVP_PKEY* key) const {
  const std::string path = folder_ + "/" + name;
  const auto write_file = [](const std::string& to, const auto& put) {
    const std::string fresh = to + ".new";
    {
      const File file(std::fopen(fresh.c_str(), "we"));
      expect(file != nullptr && ::fchmod(::fileno(file.get()), 0600) == 0 && put(file.get()) == 1, to.c_str());
    }
    std::filesystem::rename(fresh, to);
  };
  write_file(path + ".key", [&](std::FILE* file) {
    return PEM_write_PKCS8PrivateKey(file, key, nullptr, nullptr, 0, nullptr, nullptr);
  });
  write_file(path + ".crt", [&](std::FILE* file) { return PEM_write_X509(file, certificate); });
}

}  // namespace axisgate
