#include "clients/axisctl/mill/mill_profiles.h"

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "device/rml1/machine/profile_files.h"

namespace axisgate::axisctl {
namespace {

std::string names_of_profiles() {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : rml1::shipped_profiles()) names.push_back(file.stem().string());
  return fmt::format("use {}, or the file of a profile", fmt::join(names, ", "));
}

}  // namespace

rml1::Profile mill_profile(const std::string& name) {
  if (name.empty()) throw usage("--profile does not say for which machine", names_of_profiles());
  const auto file = rml1::profile_file(name);
  if (!file) throw usage(file.error().message, file.error().hint);
  const auto profile = rml1::load_profile(file->string());
  if (profile) return *profile;
  for (const ConfigError& error : profile.error()) print_note(to_string(error));
  throw usage(fmt::format("the profile {} is not valid", name), "correct the errors above");
}

}  // namespace axisgate::axisctl
