#include "server/config/network.h"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <charconv>
#include <string>

#include "device/core/explain.h"
#include "server/config/default_socket.h"
#include "server/connections/certificates.h"

namespace axisgate::server {
namespace {

bool is_loopback(std::string_view host) { return host == "::1" || host == "127.0.0.1"; }

// Accepts addresses only, since a listener takes no names.
bool is_address(const std::string& host) {
  in6_addr bytes{};
  return ::inet_pton(AF_INET, host.c_str(), &bytes) == 1 || ::inet_pton(AF_INET6, host.c_str(), &bytes) == 1;
}

std::optional<TcpAddress> parse_address(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  const std::string_view port = text.substr(colon + 1);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  if (host == "localhost") host = "127.0.0.1";
  TcpAddress address{std::string(host), 0};
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (host.empty() || error != std::errc() || end != port.data() + port.size()) return std::nullopt;
  return address;
}

void read_listen(ConfigTable& table, TcpAddress& address) {
  const std::optional<std::string> text = table.text("listen");
  const std::optional<TcpAddress> parsed = text ? parse_address(*text) : std::nullopt;
  if (parsed && is_address(parsed->host)) {
    address = *parsed;
  } else if (text) {
    table.error("listen", fmt::format("\"{}\" is not ADDRESS:PORT, e.g. \"0.0.0.0:{}\" for all of this machine's "
                                      "addresses or \"192.168.0.5:{}\" for one",
                                      *text, kNetworkPort, kNetworkPort));
  } else if (!table.has("listen")) {
    table.missing("listen",
                  fmt::format("ADDRESS:PORT, e.g. \"0.0.0.0:{}\" for all of this machine's addresses", kNetworkPort));
  }
}

// Returns the path of a file that `check` accepts. Otherwise reports an error and returns an empty string.
template <class Check>
std::string read_file(ConfigTable& table, std::string_view key, Check check) {
  const std::optional<std::string> path = table.text(key);
  if (!path) return "";
  if (path->empty() || path->front() != '/') {
    table.error(key, fmt::format("\"{}\" is not an absolute path", *path));
    return "";
  }
  const Result<void> good = check(*path);
  if (!good) table.error(key, explain(good.error()));
  return good ? *path : "";
}

}  // namespace

std::string to_string(const TcpAddress& address) {
  const bool version_6 = address.host.find(':') != std::string::npos;
  return version_6 ? fmt::format("[{}]:{}", address.host, address.port)
                   : fmt::format("{}:{}", address.host, address.port);
}

void read_loopback(ConfigTable& table, std::string_view key, std::string_view what, TcpAddress& address) {
  const std::optional<std::string> text = table.text(key);
  if (!text) return;
  const std::optional<TcpAddress> parsed = parse_address(*text);
  if (!parsed) {
    table.error(key, fmt::format("\"{}\" is not HOST:PORT, e.g. \"127.0.0.1:{}\"", *text, address.port));
  } else if (!is_loopback(parsed->host)) {
    const std::string_view instead =
        key == "listen" ? "other machines are served by the table [network], with TLS and callers who are known: "
                          "listen, certificate, key, and client_ca or tokens"
                        : "let a Prometheus on this machine read them, or one elsewhere through a tunnel (ssh -L)";
    table.error(key, fmt::format("\"{}\" would offer {} to the network, where it could be read and changed on its "
                                 "way by anybody; use 127.0.0.1, localhost or [::1] here; {}",
                                 *text, what, instead));
  } else {
    address = *parsed;
  }
}

std::optional<NetworkConfig> read_network(ConfigTable& root, std::string_view file, std::vector<ConfigError>& errors) {
  const toml::table* source = root.table("network");
  if (source == nullptr) return std::nullopt;
  ConfigTable table(*source, "network", std::string(file), errors);
  NetworkConfig network;
  read_listen(table, network.listen);
  network.certificate = read_file(table, "certificate", check_certificate);
  network.key = read_file(table, "key", [&](const std::string& path) { return check_key(path, network.certificate); });
  network.client_ca = read_file(table, "client_ca", check_certificate);
  if (!table.has("certificate")) table.missing("certificate", "the PEM file of the daemon's certificate");
  if (!table.has("key")) table.missing("key", "the PEM file of that certificate's private key");
  table.refuse_unknown();
  return network;
}

}  // namespace axisgate::server
