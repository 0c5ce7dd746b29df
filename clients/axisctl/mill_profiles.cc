#include "clients/axisctl/mill_profiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <filesystem>
#include <system_error>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

namespace fs = std::filesystem;

// Installed beside this program, or in the tree that it was built in.
std::vector<fs::path> shipped() {
  std::error_code ignored;
  const fs::path programs = fs::read_symlink("/proc/self/exe", ignored).parent_path();
  std::vector<fs::path> files;
  for (const fs::path& folder :
       {programs.parent_path() / "share/axisgate/mills", programs.parent_path().parent_path() / "deploy/mills"}) {
    for (fs::directory_iterator entry(folder, ignored), end; entry != end; entry.increment(ignored)) {
      if (entry->path().extension() == ".toml") files.push_back(entry->path());
    }
    if (!files.empty()) break;
  }
  std::sort(files.begin(), files.end());
  return files;
}

fs::path file_of(const std::string& name) {
  if (name.find('/') != std::string::npos || name.ends_with(".toml")) return name;
  std::string known;
  for (const fs::path& file : shipped()) {
    if (file.stem().string() == boost::algorithm::to_lower_copy(name)) return file;
    known += (known.empty() ? "" : ", ") + file.stem().string();
  }
  throw usage(fmt::format("there is no profile \"{}\"", name),
              known.empty() ? "name the file of a profile" : "use " + known + ", or the file of a profile");
}

}  // namespace

rml1::Profile mill_profile(const std::string& name) {
  const auto profile = rml1::load_profile(file_of(name).string());
  if (profile) return *profile;
  for (const ConfigError& error : profile.error()) print_note(to_string(error));
  throw usage(fmt::format("the profile {} is not valid", name), "correct the errors above");
}

std::vector<rml1::KnownMachine> known_mills() {
  std::vector<rml1::KnownMachine> machines;
  for (const fs::path& file : shipped()) {
    if (const auto profile = rml1::load_profile(file.string())) {
      machines.push_back({profile->name, profile->step_mm, profile->z_mm, profile->speed.cutting_maximum});
    }
  }
  return machines;
}

}  // namespace axisgate::axisctl
