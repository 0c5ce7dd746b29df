// The configuration of one axis and what it carries, checked before the daemon starts.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "device/core/quantity.h"
#include "device/core/time.h"
#include "device/stage/axes.h"

namespace axisgate::stage {

// How far and how fast an axis may be moved; checked before anything is sent.
struct AxisLimits {
  std::optional<Quantity> travel_minimum;  // inclusive, in the axis's frame
  std::optional<Quantity> travel_maximum;
  std::optional<Quantity> maximum_speed;  // per second
  bool require_homing = false;            // no other motion before it has homed
};

// For some callers it is less. What is left out, or wider than everybody's, changes nothing.
struct LimitOverride : AxisLimits {
  std::string whose;  // a role, "operator", or a caller, "token student"
};

// Which stage an axis has. How far and how fast that may go is in the axis's own limits.
struct StageProfile {
  std::string model;              // "OSMS20-85"; for people
  Scale pulse;                    // what ?:P must say of the axis (manual 10))
  std::optional<Decimal> modulo;  // degrees of one turn, of a rotary stage; above 0
};

struct AxisProfile : AxisLimits {
  std::string name;               // shown beside the number; may be empty
  Unit unit = Unit::micrometers;  // how positions are shown, and what a bare number in a request means
  std::optional<StageProfile> stage;
  std::vector<LimitOverride> overrides;

  bool rotary() const { return stage ? stage->pulse.rotary : unit == Unit::degrees; }
};

// What becomes of the motions that run when the gateway ends: they are stopped by L:, or waited for.
enum class AtExit { stop, finish };

// What a lease's holder has set for good (manual 89) D:, 96) O:, 97) to 101) T:): when the lease has ended, the
// previous value is restored, or the new one is kept.
enum class AtLeaseEnd { restored, kept };

// The configuration of a stage controller of any kind. Its kind's own profile adds to it.
struct Profile {
  std::string name = "stage";
  std::string serial_number;  // empty: any unit is accepted, and then stays the one until the daemon ends
  int baud = 38400;           // for the time that a line takes
  Duration reply_limit = std::chrono::milliseconds(500);  // from the last byte sent to the reply's last byte
  Duration idle_poll = std::chrono::seconds(1);
  Duration moving_poll = std::chrono::milliseconds(100);
  std::array<AxisProfile, kAxisCount> axes;
  AtExit at_exit = AtExit::stop;
  AtLeaseEnd settings_at_lease_end = AtLeaseEnd::restored;
};

}  // namespace axisgate::stage
