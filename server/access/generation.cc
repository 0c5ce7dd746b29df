#include "server/access/generation.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "server/access/synced_file.h"

namespace axisgate::server {

Result<NewGeneration> next_generation(const std::string& state_directory, std::uint32_t seconds_since_1970) {
  const std::string path = state_directory + "/generation";
  const Result<std::string> text = read_state_file(path);
  if (!text) return tl::unexpected(text.error());
  std::uint32_t last = 0;
  std::istringstream(*text) >> last;
  const std::uint32_t next = std::max(last + 1, seconds_since_1970);
  return NewGeneration{next, replace_synced(path, fmt::format("{}\n", next))};
}

}  // namespace axisgate::server
