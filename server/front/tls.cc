#include "server/front/tls.h"

#include <fmt/format.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "device/link/asio_tls.h"
#include "server/access/access.h"
#include "server/limits.h"
#include "server/log.h"

namespace axisgate::front {
namespace {

namespace ssl = boost::asio::ssl;

constexpr std::size_t kNameBytesMax = 64;  // X.520's upper bound of a common name

// Selects HTTP/2 by ALPN (RFC 9113, 3.2).
int choose_h2(SSL*, const unsigned char** chosen, unsigned char* size, const unsigned char* offered,
              unsigned offered_size, void*) {
  static constexpr unsigned char kH2[] = {2, 'h', '2'};
  unsigned char* selected = nullptr;
  const int found = ::SSL_select_next_proto(&selected, size, kH2, sizeof(kH2), offered, offered_size);
  *chosen = selected;
  return found == OPENSSL_NPN_NEGOTIATED ? SSL_TLSEXT_ERR_OK : SSL_TLSEXT_ERR_ALERT_FATAL;
}

// Returns the caller's name if the certificate has exactly one usable common name.
std::optional<std::string> common_name(SSL* session) {
  const std::unique_ptr<X509, decltype(&::X509_free)> certificate(::SSL_get1_peer_certificate(session), ::X509_free);
  if (!certificate) return std::nullopt;
  const X509_NAME* subject = ::X509_get_subject_name(certificate.get());
  const int place = ::X509_NAME_get_index_by_NID(subject, NID_commonName, -1);
  if (place < 0 || ::X509_NAME_get_index_by_NID(subject, NID_commonName, place) >= 0) return std::nullopt;
  unsigned char* text = nullptr;
  const int size = ::ASN1_STRING_to_UTF8(&text, ::X509_NAME_ENTRY_get_data(::X509_NAME_get_entry(subject, place)));
  if (size < 0) return std::nullopt;
  const std::string name(reinterpret_cast<char*>(text), static_cast<std::size_t>(size));
  ::OPENSSL_free(text);
  const auto printable = [](char c) { return c >= ' ' && c <= '~'; };
  if (name.empty() || name.size() > kNameBytesMax || !std::ranges::all_of(name, printable)) return std::nullopt;
  return server::certificate_caller(name);
}

std::string changed(const std::string& path) {
  struct stat file {};
  if (path.empty() || ::stat(path.c_str(), &file) != 0) return "-";
  return fmt::format("{}.{} {} ", file.st_mtim.tv_sec, file.st_mtim.tv_nsec, file.st_ino);
}

}  // namespace

class TlsFiles::Context {
 public:
  explicit Context(const server::NetworkConfig& network) : context_(ssl::context::tls_server) {
    ::SSL_CTX_set_min_proto_version(context_.native_handle(), TLS1_3_VERSION);
    ::SSL_CTX_set_alpn_select_cb(context_.native_handle(), choose_h2, nullptr);
    context_.use_certificate_chain_file(network.certificate);
    context_.use_private_key_file(network.key, ssl::context::pem);
    if (network.client_ca.empty()) return;
    context_.load_verify_file(network.client_ca);
    context_.set_verify_mode(ssl::verify_peer);
  }

  ssl::context& get() { return context_; }

 private:
  ssl::context context_;
};

namespace {

class TlsWire final : public Wire {
 public:
  TlsWire(Socket socket, std::shared_ptr<void> context, ssl::context& ssl, TlsFiles::OnHandshake done)
      : context_(std::move(context)), stream_(std::move(socket), ssl) {
    stream_.async_handshake(ssl::stream_base::server, [this, done = std::move(done)](const Error& error) {
      done(error, error ? std::nullopt : common_name(stream_.native_handle()));
    });
  }

  void read_some(OnBytes handler) override {
    bytes_.resize(kPiece);
    stream_.async_read_some(boost::asio::buffer(bytes_),
                            [this, handler = std::move(handler)](const Error& error, std::size_t size) {
                              bytes_.resize(size);
                              handler(error, std::exchange(bytes_, {}));
                            });
  }
  void write(boost::asio::const_buffer bytes, std::function<void(Error)> handler) override {
    boost::asio::async_write(stream_, bytes,
                             [handler = std::move(handler)](const Error& error, std::size_t) { handler(error); });
  }
  void close() override {
    Error ignored;
    stream_.lowest_layer().shutdown(Socket::shutdown_both, ignored);
    stream_.lowest_layer().close(ignored);
  }

 private:
  const std::shared_ptr<void> context_;
  ssl::stream<Socket> stream_;
  std::string bytes_;  // being read
};

}  // namespace

TlsFiles::TlsFiles(server::NetworkConfig network) : network_(std::move(network)) {}
TlsFiles::~TlsFiles() = default;

// Returns the newest usable files. A key and a certificate that do not match are a replacement in progress; the
// previous pair stays in use.
std::shared_ptr<TlsFiles::Context> TlsFiles::newest() {
  const TimePoint now = monotonic_now();
  if (context_ && now - looked_ < server::kCertificateFileLook) return context_;
  looked_ = now;
  std::string seen = changed(network_.certificate) + changed(network_.key) + changed(network_.client_ca);
  if (context_ && seen == seen_) return context_;
  try {
    context_ = std::make_shared<Context>(network_);
    seen_ = std::move(seen);
  } catch (const boost::system::system_error& error) {
    server::log::warn("the certificate files of [network] cannot be used ({}); replace key and certificate together",
                      error.what());
  }
  return context_;
}

std::unique_ptr<Wire> TlsFiles::begin(Socket socket, OnHandshake done) {
  const std::shared_ptr<Context> context = newest();
  if (!context) return nullptr;
  return std::make_unique<TlsWire>(std::move(socket), context, context->get(), std::move(done));
}

}  // namespace axisgate::front
