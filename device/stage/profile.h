// The configuration of a controller's axes and stages, checked before the daemon starts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/core/quantity.h"
#include "device/core/time.h"
#include "device/stage/axes.h"

namespace axisgate::stage {

// Travel and speed limits of an axis, checked before anything is sent.
struct AxisLimits {
  std::optional<Quantity> travel_minimum;  // inclusive, in the axis's frame
  std::optional<Quantity> travel_maximum;
  std::optional<Quantity> maximum_speed;  // per second
  bool require_homing = false;            // refuse any other motion until the axis has homed
};

// Stricter limits for some callers. A limit that is absent or less strict than the general one has no effect.
struct LimitOverride : AxisLimits {
  std::string whose;  // role ("operator") or caller ("token student")
};

// The stage model mounted on an axis. Its travel and speed limits are in the axis's own limits.
struct StageProfile {
  std::string model;              // "OSMS20-85", shown to people
  Scale pulse;                    // resolution that the controller must report for the axis
  std::optional<Decimal> modulo;  // degrees of one turn of a rotary stage; above 0
};

struct AxisProfile : AxisLimits {
  std::string name;               // shown beside the number; may be empty
  Unit unit = Unit::micrometers;  // unit in which positions are shown, and of numbers without a unit in a request
  std::optional<StageProfile> stage;
  std::vector<LimitOverride> overrides;

  bool rotary() const { return stage ? stage->pulse.rotary : unit == Unit::degrees; }
};

// Treatment of running motions when the gateway ends: stop them, or wait for them.
enum class AtExit { stop, finish };

// Treatment of the settings that a lease's holder has changed (speeds, outputs, trigger) when the lease ends: restore
// the previous values, or keep the new ones.
enum class AtLeaseEnd { restored, kept };

// The configuration of a stage controller of any kind. Each kind adds its own profile.
struct Profile {
  std::string name = "stage";
  std::string serial_number;  // empty: any controller is accepted; the first one is then required until the daemon ends
  int baud = 38400;           // used to compute the transmission time of a line
  Duration reply_limit = std::chrono::milliseconds(500);  // from the last byte sent to the reply's last byte
  Duration idle_poll = std::chrono::seconds(1);
  Duration moving_poll = std::chrono::milliseconds(100);
  std::array<AxisProfile, kAxesMax> axes;
  AtExit at_exit = AtExit::stop;
  AtLeaseEnd settings_at_lease_end = AtLeaseEnd::restored;
  std::int64_t speed_max = kPulsesMax;  // pulses/s: the kind's limit, whatever the configuration

  const AxisProfile& axis(int number) const { return axes[static_cast<std::size_t>(number - 1)]; }
};

}  // namespace axisgate::stage
