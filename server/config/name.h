// Rule for the names of devices and axes in the configuration, and of tokens.
#pragma once

#include <algorithm>
#include <string_view>

namespace axisgate::server {

inline constexpr std::string_view kNameRule =
    "a letter, then letters, digits, '-' or '_', at most 32 in all: names are part of resource names and metrics";

// Independent of the locale, unlike std::isalpha.
inline bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
inline bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= 32 && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_'; });
}

}  // namespace axisgate::server
