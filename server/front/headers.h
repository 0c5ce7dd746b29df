// The headers of a call, as HTTP/2 carries them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::front {

struct Header {
  std::string name;  // lower case; includes pseudo-headers such as ":path"
  std::string value;
};
using Headers = std::vector<Header>;

// Returns the value of the first header of that name. nullopt if there is none.
std::optional<std::string_view> find(const Headers& headers, std::string_view name);

// Returns the cost of one field in a header list (RFC 9113, 6.5.2).
inline std::size_t list_bytes(std::size_t name, std::size_t value) {
  constexpr std::size_t kOverhead = 32;
  return name + value + kOverhead;
}

}  // namespace axisgate::front
