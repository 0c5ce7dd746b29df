// TLS 1.3 for callers from other machines. It ends here, so that the front sees their frames.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "device/link/clock.h"
#include "server/config/config.h"
#include "server/front/wire.h"

namespace axisgate::front {

// The daemon's certificate and the authority of the callers' certificates, read again when the files have changed. Open
// connections keep their initial files. Use on one thread.
class TlsFiles {
 public:
  explicit TlsFiles(server::NetworkConfig network);
  ~TlsFiles();

  // Returns a wire whose handshake is still to come. `done` is called once: with the caller's name, "cert alice"
  // (nullopt without a certificate or a usable name), or with the error of a failed handshake.
  using OnHandshake = std::function<void(const Wire::Error& error, std::optional<std::string> name)>;
  std::unique_ptr<Wire> begin(Socket socket, OnHandshake done);

 private:
  class Context;
  std::shared_ptr<Context> newest();

  const server::NetworkConfig network_;
  std::shared_ptr<Context> context_;
  std::string seen_;  // times at which the files were changed
  TimePoint looked_{};
};

}  // namespace axisgate::front
