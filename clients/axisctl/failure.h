// How axisctl ends when it does not end well. Thrown from wherever it is noticed and caught once, in main.
#pragma once

#include <string>

#include "axisgate/v1/common.pb.h"
#include "device/core/problem.h"

namespace axisgate::axisctl {

// Documented in README.md and `axisctl help`.
enum ExitCode : int {
  kDone = 0,
  kFailed = 1,  // a motion, or it was stopped, or nobody can say; a mill job that has an error, or is not FED
  kUsage = 2,
  kRefused = 3,      // the request or the device's state
  kUnavailable = 4,  // no daemon, or the line is down
  kDeadline = 5,
};

struct Failure {
  int exit_code = kFailed;
  std::string reason;   // "OUTSIDE_TRAVEL"
  std::string message;  // one sentence: what, where, why
  std::string hint;     // what to do; may be empty
};

Failure usage(std::string message, std::string hint);

// "OUTSIDE_TRAVEL", without the prefix of the API.
std::string short_name(v1::Reason reason);

// The exit code follows from the reason.
Failure to_failure(const v1::Problem& problem);

// A mistake in what was typed: always a usage error.
Failure to_usage(const Problem& problem);

}  // namespace axisgate::axisctl
