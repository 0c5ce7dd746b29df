// Where the profiles of machines are found.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/rml1/machine/known_machine.h"

namespace axisgate::rml1 {

// Those installed beside the running program, or in the tree that it was built in, by name.
std::vector<std::filesystem::path> shipped_profiles();

// Of a shipped profile's name in either case, "mdx-20"; a path or a name ending in .toml is the file itself, which may
// be missing. An unknown name is refused, with the known ones.
Result<std::filesystem::path> profile_file(const std::string& name);

// Returns the machines of all shipped profiles, for each of which a job may have been made. Unreadable profiles are
// left out.
std::vector<KnownMachine> known_machines();

}  // namespace axisgate::rml1
