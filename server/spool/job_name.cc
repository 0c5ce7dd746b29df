#include "server/spool/job_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

#include "device/core/utf8.h"

namespace axisgate::server::spool {
namespace {

tl::unexpected<Problem> refuse(std::string_view why) {
  return fail(Reason::invalid_request, fmt::format("that is not a name for a job: {}", why),
              fmt::format("use 1 to {} bytes of UTF-8 without control characters, not beginning with a dot", kNameMax));
}

std::string_view last_part(std::string_view path) {
  path.remove_prefix(path.find_last_of("/\\") + 1);  // npos + 1 is 0
  path.remove_prefix(std::min(path.find_first_not_of(' '), path.size()));
  return path.substr(0, path.find_last_not_of(' ') + 1);
}

bool is_control(char32_t c) {
  const bool ends_line = c == 0x2028 || c == 0x2029;
  const bool turns_direction = (c >= 0x202A && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069);
  return c < 0x20 || (c >= 0x7F && c < 0xA0) || ends_line || turns_direction;
}

}  // namespace

Result<std::string> job_name(std::string_view text) {
  const std::string_view name = last_part(text);
  if (name.empty()) return refuse("it is empty");
  if (name.size() > kNameMax) return refuse(fmt::format("it has {} bytes", name.size()));
  if (name.front() == '.') return refuse("it begins with a dot");
  for (std::string_view rest = name; !rest.empty();) {
    const std::optional<char32_t> character = take_character(rest);
    if (!character) return refuse("it is not UTF-8");
    if (is_control(*character))
      return refuse(fmt::format("it has the control character U+{:04X}", std::uint32_t{*character}));
  }
  return std::string(name);
}

}  // namespace axisgate::server::spool
