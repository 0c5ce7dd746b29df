#include "server/front/headers.h"

#include <algorithm>

namespace axisgate::front {

std::optional<std::string_view> find(const Headers& headers, std::string_view name) {
  const auto found = std::ranges::find(headers, name, &Header::name);
  if (found == headers.end()) return std::nullopt;
  return found->value;
}

}  // namespace axisgate::front
