// Commands of the controller itself, for functions that the other subjects do not cover.
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

// A Transaction is a list of command lines, with the time limit for their replies and completions: above 0, at most 10
// minutes; nullopt: 20 s.
struct Transaction {
  std::vector<std::string> lines;
  std::optional<Duration> timeout{};
};

// Thread safe.
class Commands {
 public:
  // The referenced objects must outlive this one; `access` must also outlive the gateway.
  Commands(server::Gateway& gateway, const server::Access& access, const Pipeline& pipeline, Streams& streams)
      : gateway_(gateway), access_(access), pipeline_(pipeline), streams_(streams) {}

  // Returns the commands in the order of the controller's manual.
  Result<std::vector<stage::CommandInfo>> list(const Call& call, std::string_view device) const;

  // Streams the reply of each line, then the completions that the lines caused. Ends with deadline_passed at the
  // timeout. Returns null after a successful check with validate_only. Fails with invalid_request, malformed_line,
  // out_of_range or not_allowed, and as Kind::check_lines() does.
  Opened<stage::ExecuteEvent> execute(const Call& call, std::string_view device, Transaction transaction) const;

 private:
  Result<void> check(const Transaction& transaction, const server::Caller& caller) const;

  server::Gateway& gateway_;
  const server::Access& access_;
  const Pipeline& pipeline_;
  Streams& streams_;
};

}  // namespace axisgate::api
