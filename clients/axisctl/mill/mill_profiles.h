// Lookup of machine profiles.
#pragma once

#include <string>
#include <vector>

#include "device/rml1/machine/profile.h"

namespace axisgate::axisctl {

// Returns a shipped profile by its name, such as "mdx-20", in upper or lower case, or the profile in a file. Throws
// Failure if the profile is not valid, after printing every error in the file.
rml1::Profile mill_profile(const std::string& name);

}  // namespace axisgate::axisctl
