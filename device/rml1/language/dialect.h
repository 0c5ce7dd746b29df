// A Dialect describes the differences between the language of one machine and the guideline's.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::rml1 {

struct Dialect {
  std::vector<std::string> tolerated;  // any of "J", "!0", "!1" (2-2: "depending on the model")
  std::vector<std::string> apart;      // pairs of axes that cannot move in one group of !ZE, such as "YA"

  bool tolerates(std::string_view name) const { return std::ranges::find(tolerated, name) != tolerated.end(); }
};

}  // namespace axisgate::rml1
