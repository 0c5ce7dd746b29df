// Finds the profiles of machines.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/rml1/machine/known_machine.h"

namespace axisgate::rml1 {

// Returns the profiles installed with the running program, or in the tree that it was built in, ordered by name.
std::vector<std::filesystem::path> shipped_profiles();

// Returns the file of a shipped profile by its name in either case, such as "mdx-20". A path or a name that ends in
// .toml is the file itself, which may be missing. Fails with invalid_request if the name is unknown; the hint lists the
// known names.
Result<std::filesystem::path> profile_file(const std::string& name);

// Returns the machines of all shipped profiles: a job may have been made for any of them. Unreadable profiles are left
// out.
std::vector<KnownMachine> known_machines();

}  // namespace axisgate::rml1
