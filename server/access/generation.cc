#include "server/access/generation.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "server/access/synced_file.h"

namespace axisgate::server {
namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

std::string default_state_directory() {
  if (const std::string given = variable("STATE_DIRECTORY"); !given.empty()) return given.substr(0, given.find(':'));
  if (::geteuid() == 0) return "/var/lib/axisgate";
  if (const std::string state = variable("XDG_STATE_HOME"); !state.empty()) return state + "/axisgate";
  return variable("HOME") + "/.local/state/axisgate";
}

Result<std::uint32_t> next_generation(const std::string& state_directory, std::uint32_t seconds_since_1970) {
  const std::string path = state_directory + "/generation";
  std::uint32_t last = 0;
  std::ifstream(path) >> last;
  const std::uint32_t next = std::max(last + 1, seconds_since_1970);
  if (const auto written = replace_synced(path, fmt::format("{}\n", next)); !written) {
    return tl::unexpected(written.error());
  }
  return next;
}

}  // namespace axisgate::server
