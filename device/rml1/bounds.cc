#include "device/rml1/bounds.h"

#include <fmt/format.h>

namespace axisgate::rml1 {

std::string to_string(const Reach& reach) {
  return reach.size() == 0 ? fmt::format("{:g}", reach.lowest)
                           : fmt::format("{:g} to {:g}", reach.lowest, reach.highest);
}

}  // namespace axisgate::rml1
