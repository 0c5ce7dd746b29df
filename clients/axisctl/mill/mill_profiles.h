// Where machine profiles are found.
#pragma once

#include <string>
#include <vector>

#include "device/rml1/machine/profile.h"

namespace axisgate::axisctl {

// A shipped profile's name in either case, "mdx-20", or a file. Throws Failure when it is not valid, with every error
// of the file.
rml1::Profile mill_profile(const std::string& name);

}  // namespace axisgate::axisctl
