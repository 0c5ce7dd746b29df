// The verbs of `axisctl mill` that ask no daemon. Each returns its exit code or throws Failure.
#pragma once

#include "clients/axisctl/options.h"

namespace axisgate::axisctl {

int mill_check(const Options& options);
int mill_preview(const Options& options);

}  // namespace axisgate::axisctl
