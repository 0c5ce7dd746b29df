#include "server/api/mill/mill_operation.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "server/api/request/names.h"

namespace axisgate::api {
namespace {

using server::Mill;
using HandTurn = TurnOf<Mill>;

// Returns the act with the height of the named origin.
Result<jobs::HandAct> act_of(const HandRequest& request, const Mill& mill) {
  if (request.origin.empty()) return request.act;
  const auto* surface = std::get_if<jobs::SetZ0>(&request.act);
  if (surface != nullptr && surface->at) {
    return fail(Reason::invalid_request,
                fmt::format("Z0 cannot be both at the origin \"{}\" and at a coordinate", request.origin),
                "name the origin or z, not both");
  }
  const auto& origins = mill.config().origins;
  const auto named = std::ranges::find(origins, request.origin, &jobs::NamedOrigin::name);
  if (named == origins.end()) {
    return fail(Reason::invalid_request, fmt::format("{} has no origin \"{}\"", mill.name(), request.origin),
                "`GetMill` lists them");
  }
  if (named->z) return jobs::SetZ0{pulses(*named->z)};
  return fail(Reason::invalid_request, fmt::format("the origin {} of {} has no height", named->name, mill.name()),
              "give it one in the configuration: `z`; X and Y are set at the mill's panel");
}

Result<std::string> describe_if_possible(const HandTurn& turn, const HandRequest& request) {
  if (const Result<void> in_time = check_in_time(turn); !in_time) return tl::unexpected(in_time.error());
  const Result<jobs::HandAct> act = act_of(request, turn.device);
  if (!act) return tl::unexpected(act.error());
  return text_of(*act);
}

Result<Duration> do_it(const HandTurn& turn, const HandRequest& request) {
  const Result<jobs::HandAct> act = act_of(request, turn.device);
  if (!act) return tl::unexpected(act.error());
  return turn.controller.operate(*act, turn.context, turn.now);
}

// Returns the longest duration, as it was answered to the first request.
Result<Duration> longest_of(const HandRequest& request, const Mill& mill) {
  const Result<jobs::HandAct> act = act_of(request, mill);
  if (!act) return tl::unexpected(act.error());
  return mill.config().model->longest(*act, mill.config().sending.slack);
}

}  // namespace

void MillOperation::operate(const Call& call, std::string_view device, const Result<HandRequest>& read,
                            Answer<Duration> answer) const {
  const HandRequest request = read.value_or(HandRequest());
  pipeline_.act(
      {RequestKind::operate_mill, call, find_mill(gateway_, device), read ? std::nullopt : std::optional(read.error())},
      [request](const HandTurn& turn) { return describe_if_possible(turn, request); },
      [request, answer](const HandTurn& turn, const MutationPtr& mutation) {
        Result<Duration> longest = do_it(turn, request);
        longest ? mutation->acted(server::journal::answer_done()) : mutation->failed(longest.error());
        answer(std::move(longest));
      },
      [answer](const Problem& problem) { answer(tl::unexpected(problem)); },
      [request, answer](Mill& mill, const Result<Known>& known) {
        repeat_done(known, [&](const Result<void>& done) {
          answer(done ? longest_of(request, mill) : Result<Duration>(tl::unexpected(done.error())));
        });
      });
}

}  // namespace axisgate::api
