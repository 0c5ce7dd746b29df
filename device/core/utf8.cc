#include "device/core/utf8.h"

#include <array>
#include <bit>
#include <cstddef>

namespace axisgate {

std::optional<char32_t> take_character(std::string_view& text) {
  constexpr std::array<char32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x10000};  // least character by length
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

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    if (!take_character(text)) return false;
  }
  return true;
}

}  // namespace axisgate
