// The verbs of `axisctl mill` that ask the daemon for the name of an origin at most. Each returns its exit code or
// throws Failure.
#pragma once

#include "clients/axisctl/options.h"

namespace axisgate::axisctl {

int mill_check(const Options& options);
int mill_preview(const Options& options);

}  // namespace axisgate::axisctl
