// A Dialect is how the language of one machine differs from the guideline's.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::rml1 {

struct Dialect {
  std::vector<std::string> tolerated;  // of "J", "!0", "!1" (2-2: "depending on the model")
  std::vector<std::string> apart;      // "YA": axes that cannot move in one group of !ZE

  bool tolerates(std::string_view name) const { return std::ranges::find(tolerated, name) != tolerated.end(); }
};

}  // namespace axisgate::rml1
