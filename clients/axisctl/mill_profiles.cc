#include "clients/axisctl/mill_profiles.h"

#include <fmt/format.h>

#include <filesystem>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "device/rml1/profile_files.h"

namespace axisgate::axisctl {
rml1::Profile mill_profile(const std::string& name) {
  const auto file = rml1::profile_file(name);
  if (!file) throw usage(file.error().message, file.error().hint);
  const auto profile = rml1::load_profile(file->string());
  if (profile) return *profile;
  for (const ConfigError& error : profile.error()) print_note(to_string(error));
  throw usage(fmt::format("the profile {} is not valid", name), "correct the errors above");
}

std::vector<rml1::KnownMachine> known_mills() {
  std::vector<rml1::KnownMachine> machines;
  for (const std::filesystem::path& file : rml1::shipped_profiles()) {
    if (const auto profile = rml1::load_profile(file.string())) {
      machines.push_back({profile->name, profile->step_mm, profile->z_mm, profile->speed.cutting_maximum});
    }
  }
  return machines;
}

}  // namespace axisgate::axisctl
