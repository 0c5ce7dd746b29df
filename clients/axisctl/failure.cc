#include "clients/axisctl/failure.h"

#include <utility>

#include "clients/axisctl/hints.h"
#include "clients/cpp/src/failure.h"

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

Failure to_failure(const v1::Problem& problem) {
  return {exit_code(problem.reason()), client::reason_name(problem.reason()), problem.message(),
          with_commands(problem.hint(), problem.axis())};
}

Failure to_usage(const Problem& problem) {
  return {kUsage, std::string(name(problem.reason)), problem.message,
          with_commands(problem.hint, problem.axis.value_or(0))};
}

}  // namespace axisgate::axisctl
