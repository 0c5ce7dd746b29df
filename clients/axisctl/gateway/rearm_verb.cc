// rearm: ends the latches of a stop by somebody else.
#include <fmt/format.h>

#include <string>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/gateway/lease_board.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

void print_released(const v1::RearmResponse& response) {
  for (const v1::Latch& latch : response.latches()) {
    print_line(fmt::format("released: the stop of {} by {} at {}", scope_text(latch), latch.caller().name(),
                           time_text(latch.time())));
  }
  print_line(fmt::format("{} may move again", scope_text(response)));
}

// Explains that nothing was rearmed. A lease of another caller may have a latch, which this call could not end.
std::string nothing_rearmed(const v1::WatchLeasesResponse& board) {
  for (const v1::Lease& lease : board.leases()) {
    if (!lease.has_latch()) continue;
    return fmt::format(
        "you have no latch; a lease of {} has one on {}: to end it, run `axisctl rearm` as its holder, or inside its "
        "`axisctl lease run`",
        lease.holder().name(), scope_text(lease.latch()));
  }
  for (const v1::HeldBack& one : board.held_back()) {
    return fmt::format("you have no latch; {} has one on {}, and must rearm", one.caller().name(),
                       scope_text(one.latch()));
  }
  return "there is no latch";
}

int rearm(const Session& session) {
  v1::RearmRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  const v1::Device device = any_device(session);
  request.set_device(device.name());
  const v1::RearmResponse response =
      session.connection.call(session.connection.control, &v1::ControlService::Stub::Rearm, request, kQuestionLimit);
  if (session.options.json) {
    print_json(response);
    return kDone;
  }
  if (response.latches().empty()) {
    print_line(nothing_rearmed(board_now(session, request.device())));
  } else {
    print_released(response);
  }
  if (device.has_emergency_latch()) {
    print_line(fmt::format("the emergency stop of {} remains, and nothing moves: `axisctl clear` ends it",
                           device.emergency_latch().caller().name()));
  }
  return kDone;
}

constexpr Verb kRearmVerbs[] = {
    {.words = "rearm",
     .heading = Heading::stopping,
     .description = "after a stop by somebody else: allow your motions again; moves nothing",
     .help =
         R"(A stop by somebody else sets a latch: your motions on these axes are refused until you rearm. This moves nothing, and
the stopped motion does not continue. Type it in any terminal: it also ends the latches of your leases.
After an emergency stop by somebody else, type `axisctl rearm` first, then `axisctl clear`.)",
     .examples = "axisctl rearm",
     .run = rearm},
};

}  // namespace

std::span<const Verb> rearm_verbs() { return kRearmVerbs; }

}  // namespace axisgate::axisctl
