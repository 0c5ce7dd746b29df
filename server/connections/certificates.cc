#include "server/connections/certificates.h"

#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <ctime>
#include <memory>
#include <system_error>
#include <utility>
#include <vector>

#include "server/access/writers.h"

namespace axisgate::server {
namespace {

template <auto Free>
struct Freed {
  template <class T>
  void operator()(T* object) const {
    Free(object);
  }
};
using File = std::unique_ptr<std::FILE, Freed<std::fclose>>;
using Certificate = std::unique_ptr<X509, Freed<X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Freed<EVP_PKEY_free>>;

tl::unexpected<Problem> refuse(std::string message, std::string hint) {
  return fail(Reason::invalid_request, std::move(message), std::move(hint));
}

Result<File> open(const std::string& path) {
  errno = 0;
  File file(std::fopen(path.c_str(), "re"));
  if (file != nullptr) return file;
  return refuse(fmt::format("{} cannot be opened: {}", path, std::generic_category().message(errno)),
                "the user as whom the daemon runs must be able to read it");
}

// Supplies no passphrase: nobody is there to type it when a daemon starts at night.
int no_passphrase(char*, int, int, void*) { return 0; }

Result<std::vector<Certificate>> read_certificates(const std::string& path) {
  const Result<File> file = open(path);
  if (!file) return tl::unexpected(file.error());
  std::vector<Certificate> certificates;
  while (X509* read = PEM_read_X509(file->get(), nullptr, no_passphrase, nullptr)) certificates.emplace_back(read);
  const auto error = ERR_peek_last_error();
  ERR_clear_error();
  if (certificates.empty() || ERR_GET_REASON(error) != PEM_R_NO_START_LINE) {
    return refuse(fmt::format("{} {}", path, certificates.empty() ? "holds no certificate" : "is damaged"),
                  "it must be PEM: -----BEGIN CERTIFICATE-----");
  }
  return certificates;
}

}  // namespace

Result<void> check_certificate(const std::string& path) {
  const auto certificates = read_certificates(path);
  return certificates ? Result<void>() : tl::unexpected(certificates.error());
}

Result<void> check_key(const std::string& path, const std::string& certificate) {
  const Result<File> file = open(path);
  if (!file) return tl::unexpected(file.error());
  const Key key(PEM_read_PrivateKey(file->get(), nullptr, no_passphrase, nullptr));
  ERR_clear_error();
  if (key == nullptr) {
    return refuse(fmt::format("{} holds no private key that can be read without a passphrase", path),
                  "it must be PEM: -----BEGIN PRIVATE KEY-----");
  }
  struct stat status {};
  if (::fstat(::fileno(file->get()), &status) == 0 && (status.st_mode & (S_IROTH | S_IWOTH)) != 0) {
    return refuse(fmt::format("{} may be read or written by everybody on this machine", path),
                  fmt::format("chmod o= {}", path));
  }
  if (const Result<void> checked = check_writers(path); !checked) {
    return refuse(fmt::format("{} {}", path, checked.error().message), checked.error().hint);
  }
  const auto certificates = certificate.empty() ? Result<std::vector<Certificate>>() : read_certificates(certificate);
  if (!certificates || certificates->empty() || X509_check_private_key(certificates->front().get(), key.get()) == 1) {
    return {};
  }
  ERR_clear_error();
  return refuse(fmt::format("{} is not the key of the certificate {}", path, certificate),
                "the daemon's own certificate must be the first in its file");
}

Result<WallTime> expiry(const std::string& path) {
  const auto certificates = read_certificates(path);
  if (!certificates) return tl::unexpected(certificates.error());
  std::tm utc{};
  if (ASN1_TIME_to_tm(X509_get0_notAfter(certificates->front().get()), &utc) != 1) {
    return refuse(fmt::format("{} does not say when it expires", path), "have a new one made");
  }
  return std::chrono::system_clock::from_time_t(::timegm(&utc));
}

}  // namespace axisgate::server
