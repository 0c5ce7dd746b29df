// A configured work origin.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace axisgate::jobs {

struct NamedOrigin {
  std::string name;
  std::int64_t x = 0, y = 0;        // in steps of the machine, from its home corner, within its work area
  std::optional<std::int64_t> z{};  // machine coordinate of Z0, in steps; nullopt: set at the machine
};

// Limits for the coordinates of a NamedOrigin, in steps.
struct OriginLimits {
  std::int64_t x_most = 0, y_most = 0;
  std::int64_t z_least = 0, z_most = 0;
};

}  // namespace axisgate::jobs
