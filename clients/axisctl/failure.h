// Errors that end axisctl: thrown anywhere, and caught once, in main.
#pragma once

#include <string>

#include "axisgate/v1/common.pb.h"
#include "device/core/problem.h"

namespace axisgate::axisctl {

// Exit codes, as documented in README.md and `axisctl help`.
enum ExitCode : int {
  kDone = 0,
  kFailed = 1,  // a motion failed, was stopped or has an unknown outcome; a mill job has an error or was not FED
  kUsage = 2,
  kRefused = 3,      // because of the request or the device's state
  kUnavailable = 4,  // no daemon, or the line is down
  kDeadline = 5,
};

struct Failure {
  int exit_code = kFailed;
  std::string reason;   // "OUTSIDE_TRAVEL"
  std::string message;  // one sentence: the error, its place and its reason
  std::string hint;     // remedy; may be empty
};

Failure usage(std::string message, std::string hint);

// Converts a problem; its reason determines the exit code.
Failure to_failure(const v1::Problem& problem);

// Converts a problem with typed text, which is always a usage error.
Failure to_usage(const Problem& problem);

}  // namespace axisgate::axisctl
