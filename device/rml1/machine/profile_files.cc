#include "device/rml1/machine/profile_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/algorithm/string/case_conv.hpp>
#include <system_error>

#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

namespace fs = std::filesystem;

std::vector<fs::path> shipped_profiles() {
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

Result<fs::path> profile_file(const std::string& name) {
  if (name.find('/') != std::string::npos || name.ends_with(".toml")) return fs::path(name);
  std::string known;
  for (const fs::path& file : shipped_profiles()) {
    if (file.stem().string() == boost::algorithm::to_lower_copy(name)) return file;
    known += (known.empty() ? "" : ", ") + file.stem().string();
  }
  return fail(Reason::invalid_request, fmt::format("there is no profile \"{}\"", name),
              known.empty() ? "name the file of a profile" : "use " + known + ", or the file of a profile");
}

std::vector<KnownMachine> known_machines() {
  std::vector<KnownMachine> machines;
  for (const fs::path& file : shipped_profiles()) {
    if (const auto profile = load_profile(file.string())) {
      machines.push_back({profile->name, profile->step_mm, profile->z_mm, profile->speed.cutting_maximum});
    }
  }
  return machines;
}

}  // namespace axisgate::rml1
