// TLS 1.3 for those who call from other machines. It ends here, so that the front sees their frames.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "device/link/clock.h"
#include "server/config/config.h"
#include "server/front/wire.h"

namespace axisgate::front {

// The daemon's certificate and who signs those of callers, read again when the files have changed; open connections
// keep what they began with. On one thread.
class TlsFiles {
 public:
  explicit TlsFiles(server::NetworkConfig network);
  ~TlsFiles();

  // A wire whose handshake is still to come, with its caller's name by then: "cert alice", or nothing without a
  // certificate or a usable name. Once; no handler call after close(). `done` receives the error of a failed one.
  using OnHandshake = std::function<void(const Wire::Error& error, std::optional<std::string> name)>;
  std::unique_ptr<Wire> begin(Socket socket, OnHandshake done);

 private:
  class Context;
  std::shared_ptr<Context> newest();

  const server::NetworkConfig network_;
  std::shared_ptr<Context> context_;
  std::string seen_;  // of the files: when they were changed
  TimePoint looked_{};
};

}  // namespace axisgate::front
