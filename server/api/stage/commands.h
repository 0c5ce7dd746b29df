// A controller's own commands, for what the other subjects do not cover.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/command_info.h"
#include "device/stage/requests.h"
#include "server/access/access.h"
#include "server/api/request/call.h"
#include "server/api/request/pipeline.h"
#include "server/api/request/subscription.h"
#include "server/gateway.h"

namespace axisgate::api {

// The lines of one transaction, and for how long its replies and completions are waited for: above 0, 10 minutes at
// most; nothing: 20 s.
struct Transaction {
  std::vector<std::string> lines;
  std::optional<Duration> timeout{};
};

// Thread safe.
class Commands {
 public:
  // All outlive this, and `access` the gateway.
  Commands(server::Gateway& gateway, const server::Access& access, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), access_(access), pipeline_(pipeline), streams_(streams) {}

  // In the order of the controller's manual.
  Result<std::vector<stage::CommandInfo>> list(const Call& call, std::string_view device) const;

  // Each line's reply, then the completions that they caused. Ends with deadline_passed at the timeout. Null: it was to
  // be checked only. invalid_request, malformed_line, out_of_range, not_allowed, and as Kind::check_lines().
  Opened<stage::ExecuteEvent> execute(const Call& call, std::string_view device, Transaction transaction) const;

 private:
  Result<void> check(const Transaction& transaction, const server::Caller& caller) const;

  server::Gateway& gateway_;
  const server::Access& access_;
  const Pipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
