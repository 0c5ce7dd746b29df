#include "device/rml1/machine/bounds.h"

#include <fmt/format.h>

namespace axisgate::rml1 {

std::string to_string(const Reach& reach) {
  const std::string lowest = fmt::format("{:g}", reach.lowest), highest = fmt::format("{:g}", reach.highest);
  return lowest == highest ? lowest : lowest + " to " + highest;
}

}  // namespace axisgate::rml1
