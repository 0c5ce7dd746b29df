// The headers of a call, as HTTP/2 carries them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::front {

struct Header {
  std::string name;  // lower case, ":path" among them
  std::string value;
};
using Headers = std::vector<Header>;

// The first of that name; nothing without one.
std::optional<std::string_view> find(const Headers& headers, std::string_view name);

// Returns what one field costs in a header list (RFC 9113, 6.5.2).
inline std::size_t list_bytes(std::size_t name, std::size_t value) {
  constexpr std::size_t kOverhead = 32;
  return name + value + kOverhead;
}

}  // namespace axisgate::front
