// UTF-8 (RFC 3629, section 3), read character by character.
#pragma once

#include <optional>
#include <string_view>

namespace axisgate {

// Takes the first character off `text`, which is not empty. Returns nullopt if the text does not begin with UTF-8.
std::optional<char32_t> take_character(std::string_view& text);

bool is_utf8(std::string_view text);

}  // namespace axisgate
