#include "device/jobs/bounds.h"

#include <fmt/format.h>

namespace axisgate::jobs {

std::string to_string(const Reach& reach) {
  const std::string lowest = fmt::format("{:g}", reach.lowest), highest = fmt::format("{:g}", reach.highest);
  return lowest == highest ? lowest : lowest + " to " + highest;
}

}  // namespace axisgate::jobs
