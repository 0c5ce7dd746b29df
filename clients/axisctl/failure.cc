#include "clients/axisctl/failure.h"

#include <utility>

#include "clients/axisctl/hints.h"

namespace axisgate::axisctl {
namespace {

int exit_code(v1::Reason reason) {
  switch (reason) {
    case v1::REASON_LINK_DOWN:
    case v1::REASON_JOURNAL_UNAVAILABLE:
    case v1::REASON_NOT_SENT:
    case v1::REASON_REPLY_TIMED_OUT:
    case v1::REASON_LINE_FAULT:
    case v1::REASON_DAEMON_ENDING:
    case v1::REASON_COMPLETION_OUTSTANDING:
      return kUnavailable;
    case v1::REASON_DEADLINE_PASSED:
      return kDeadline;
    case v1::REASON_UNSPECIFIED:
    case v1::REASON_STOPPED:
    case v1::REASON_TARGET_NOT_REACHED:
    case v1::REASON_OUTCOME_UNKNOWN:
    case v1::REASON_INTERNAL:
      return kFailed;
    default:
      return kRefused;
  }
}

}  // namespace

Failure usage(std::string message, std::string hint) {
  return {kUsage, "INVALID_REQUEST", std::move(message), std::move(hint)};
}

std::string short_name(v1::Reason reason) {
  constexpr std::string_view prefix = "REASON_";
  const std::string& name = v1::Reason_Name(reason);
  // A newer daemon may send reasons that have no name here.
  return name.empty() ? "REASON " + std::to_string(reason) : name.substr(prefix.size());
}

Failure to_failure(const v1::Problem& problem) {
  return {exit_code(problem.reason()), short_name(problem.reason()), problem.message(),
          with_commands(problem.hint(), problem.axis())};
}

Failure to_usage(const Problem& problem) {
  return {kUsage, std::string(name(problem.reason)), problem.message,
          with_commands(problem.hint, problem.axis.value_or(0))};
}

}  // namespace axisgate::axisctl
