// Lookup of a work origin in the daemon's configuration, for the check of a job file.
#pragma once

#include <string>

#include "clients/axisctl/arguments/options.h"
#include "device/rml1/machine/machine.h"

namespace axisgate::axisctl {

// Asks the daemon for the place of a named origin. The mill is the one in `options`, or the only mill. Throws Failure.
jobs::Origin configured_origin(const Options& options, const std::string& name);

}  // namespace axisgate::axisctl
