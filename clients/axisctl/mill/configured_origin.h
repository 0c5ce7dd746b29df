// A work origin of the daemon's configuration, for the check of a file.
#pragma once

#include <string>

#include "clients/axisctl/options.h"
#include "device/rml1/machine/machine.h"

namespace axisgate::axisctl {

// Asks the daemon for the place of an origin of the mill that was named, or of the only one. Throws Failure.
rml1::Origin configured_origin(const Options& options, const std::string& name);

}  // namespace axisgate::axisctl
