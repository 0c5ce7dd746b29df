#include "device/shot/command/status.h"

namespace axisgate::shot {
namespace {

using stage::Condition;
using stage::ConditionBits;

// Bits that are not conditions: normal, and an error in the last command.
constexpr ConditionBits kNormal = 1, kCommandError = 2;

constexpr ConditionBits kErrors = [] {
  ConditionBits errors = 0;
  for (int number = 3; number <= 15; ++number) errors |= stage::bit_of(static_cast<Condition>(number));
  return errors;
}();

}  // namespace

ConditionBits conditions_in(AxisStatusBits status) {
  ConditionBits conditions = status.raw & ~(kNormal | kCommandError) & (bit_of(Condition::origin_sensor) * 2 - 1);
  const bool explained = (status.raw & (kNormal | kCommandError | kErrors)) != 0;
  return explained ? conditions : conditions | bit_of(Condition::unnamed_error);
}

}  // namespace axisgate::shot
