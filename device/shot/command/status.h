// Status of an axis (manual 5) Q:S), with bits numbered from 1 as in the manual.
#pragma once

#include <cstdint>

#include "device/shot/stage.h"
#include "device/stage/condition.h"

namespace axisgate::shot {

struct AxisStatusBits {
  std::uint32_t raw = 0;

  bool bit(int number) const { return (raw >> (number - 1)) & 1u; }
  bool emergency() const { return bit(6); }
  bool cw_limit() const { return bit(20); }
  bool ccw_limit() const { return bit(21); }
};
inline AxisStatusBits status_of(const AxisState& axis) { return {axis.status_bits}; }

// Returns the conditions that a status shows: conditions up to 25 have the number of their bit.
stage::ConditionBits conditions_in(AxisStatusBits status);

}  // namespace axisgate::shot
