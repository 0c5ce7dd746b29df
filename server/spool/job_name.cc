#include "server/spool/job_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <optional>

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

// Takes the first character off `text`, which is not empty. Nothing where that is no UTF-8 (RFC 3629, section 3).
std::optional<char32_t> take_character(std::string_view& text) {
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};  // by length
  const auto lead = static_cast<unsigned char>(text.front());
  const int ones = std::countl_one(lead);
  const auto length = static_cast<std::size_t>(ones == 0 ? 1 : ones);
  if (ones == 1 || length >= kLeast.size() || length > text.size()) return {};
  char32_t character = lead & (0xFFU >> ones);
  for (const char byte : text.substr(1, length - 1)) {
    const auto value = static_cast<unsigned char>(byte);
    if ((value & 0xC0) != 0x80) return {};
    character = character << 6 | (value & 0x3F);
  }
  text.remove_prefix(length);
  const bool surrogate = character >= 0xD800 && character <= 0xDFFF;
  if (character < kLeast.at(length) || surrogate || character > 0x10FFFF) return {};
  return character;
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
