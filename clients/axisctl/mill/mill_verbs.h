// Verbs of `axisctl mill` that need no daemon, except to look up a named origin. Each returns its exit code or throws
// Failure.
#pragma once

#include "clients/axisctl/options.h"

namespace axisgate::axisctl {

int mill_check(const Options& options);
int mill_preview(const Options& options);

}  // namespace axisgate::axisctl
