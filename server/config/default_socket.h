// Default addresses at which the daemon listens and clients connect.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace axisgate {

// Default of `listen`, and port of [network] in every example; [network] has no default.
inline constexpr std::uint16_t kGrpcPort = 50203, kNetworkPort = 50204;

inline constexpr const char* kSystemSocket = "/run/axisgate/axisgate.sock";

// Returns the value of an environment variable. Empty if it is not set.
inline std::string environment(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::string() : std::string(value);
}

// Returns the socket for the daemon: $AXISGATE_SOCKET; for root, the system's socket; $XDG_RUNTIME_DIR/axisgate.sock;
// otherwise a socket in the user's directory under /tmp, which the daemon makes with mode 0700 and refuses if it
// belongs to another user.
inline std::string default_socket_to_listen() {
  if (std::string chosen = environment("AXISGATE_SOCKET"); !chosen.empty()) return chosen;
  if (::geteuid() == 0) return kSystemSocket;
  if (std::string runtime = environment("XDG_RUNTIME_DIR"); !runtime.empty()) return runtime + "/axisgate.sock";
  return "/tmp/axisgate-" + std::to_string(::geteuid()) + "/axisgate.sock";
}

// Returns the socket for clients: $AXISGATE_SOCKET; the system's socket if it exists; otherwise the default socket of
// the user's own daemon.
inline std::string default_socket_to_connect() {
  if (std::string chosen = environment("AXISGATE_SOCKET"); !chosen.empty()) return chosen;
  std::error_code ignored;
  if (std::filesystem::exists(kSystemSocket, ignored)) return kSystemSocket;
  return default_socket_to_listen();
}

}  // namespace axisgate
