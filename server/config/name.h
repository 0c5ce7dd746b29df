// What devices and axes may be called in the configuration. Tokens are named by the same rule.
#pragma once

#include <algorithm>
#include <string_view>

namespace axisgate::server {

inline constexpr std::string_view kNameRule =
    "a letter, then letters, digits, '-' or '_', at most 32 in all: names stand in resource names and metrics";

// ASCII by hand: what a name may hold must not depend on the locale.
inline bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
inline bool is_name(std::string_view name) {
  return !name.empty() && name.size() <= 32 && is_letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '-' || c == '_'; });
}

}  // namespace axisgate::server
