#include "device/jobs/place.h"

#include <algorithm>

namespace axisgate::jobs {

std::uint64_t offset_of(std::string_view body, std::uint64_t line, std::uint64_t column) {
  std::size_t begin = 0;
  for (; line > 1 && begin < body.size(); --line) begin = std::min(body.find('\n', begin), body.size() - 1) + 1;
  return std::min<std::uint64_t>(body.size(), begin + column - 1);
}

Place place_of(std::string_view body, std::uint64_t offset) {
  const std::string_view before = body.substr(0, offset);
  const auto line = 1 + static_cast<std::uint64_t>(std::ranges::count(before, '\n'));
  const std::size_t last = before.rfind('\n');
  return {before.size(), line, before.size() - (last == std::string_view::npos ? 0 : last + 1) + 1};
}

}  // namespace axisgate::jobs
