// Where the daemon listens, and clients look for it, when nobody says otherwise.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

namespace axisgate {

// `listen` without a configuration, and `listen` of [network] in every example: that one has no default.
inline constexpr std::uint16_t kGrpcPort = 50203, kNetworkPort = 50204;

inline constexpr const char* kSystemSocket = "/run/axisgate/axisgate.sock";

// The environment's value, or empty; set but empty counts as not set.
inline std::string environment(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::string() : std::string(value);
}

// For the daemon: $AXISGATE_SOCKET; as root the system's socket; $XDG_RUNTIME_DIR/axisgate.sock; last a directory of
// the user's own under /tmp, which the daemon makes with mode 0700 and refuses when it belongs to somebody else.
inline std::string default_socket_to_listen() {
  if (std::string chosen = environment("AXISGATE_SOCKET"); !chosen.empty()) return chosen;
  if (::geteuid() == 0) return kSystemSocket;
  if (std::string runtime = environment("XDG_RUNTIME_DIR"); !runtime.empty()) return runtime + "/axisgate.sock";
  return "/tmp/axisgate-" + std::to_string(::geteuid()) + "/axisgate.sock";
}

// For clients: $AXISGATE_SOCKET; the system's socket where there is one; else where one's own daemon would listen.
inline std::string default_socket_to_connect() {
  if (std::string chosen = environment("AXISGATE_SOCKET"); !chosen.empty()) return chosen;
  std::error_code ignored;
  if (std::filesystem::exists(kSystemSocket, ignored)) return kSystemSocket;
  return default_socket_to_listen();
}

}  // namespace axisgate
