// axisgated-contrast: the daemon, but a path's refills wait their turn among everybody's questions. It shows what their
// going first is needed for, and is for nothing else.
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <string_view>

#include "server/access/access.h"
#include "server/config.h"
#include "server/connections/callers.h"
#include "server/descriptor_limit.h"
#include "server/end_signals.h"
#include "server/gateway.h"
#include "server/logging.h"
#include "server/rpc/server.h"
#include "server/saved_positions.h"

namespace axisgate {
namespace {

int serve(const char* config_path) {
  auto config = server::load_config(config_path);
  if (!config) {
    for (const auto& error : config.error()) fmt::print(stderr, "{}\n", to_string(error));
    return 2;
  }
  for (auto& device : config->devices) device.profile.refills = shrc203::Refills::among_questions;
  server::EndSignals end_signals;
  std::signal(SIGPIPE, SIG_IGN);
  server::start_logging();
  const auto positions = *server::SavedPositions::open("");
  server::Gateway gateway(*config, 1);
  server::Access access({}, server::caller_name(::geteuid()), *server::Tokens::open(""));
  const auto server = rpc::Server::start(gateway, access, *positions, {server::raise_descriptor_limit()});
  if (!server) {
    fmt::print(stderr, "axisgated-contrast: {}\n", server.error().message);
    return 1;
  }
  gateway.start();
  end_signals.wait(gateway);
  return 0;
}

}  // namespace
}  // namespace axisgate

int main(int count, char** words) {
  if (count == 3 && std::string_view(words[1]) == "--config") return axisgate::serve(words[2]);
  fmt::print(stderr, "usage: axisgated-contrast --config FILE\n");
  return 2;
}
