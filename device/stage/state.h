// The state of one controller as known to the gateway, published as a whole at every change.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/core/quantity.h"
#include "device/core/time.h"
#include "device/stage/axes.h"
#include "device/stage/condition.h"
#include "device/stage/stop.h"
#include "device/stage/trigger.h"

namespace axisgate::stage {

enum class LinkState {
  down,        // the line is closed, or the controller does not answer
  connecting,  // the line is open and the handshake runs
  up,          // the configured controller answers
  doubtful,    // the barrier runs, after a missed reply or an unreadable one
  babbling,    // the device sends without end; the line is closed, and opened again from time to time
};
std::string_view name(LinkState state);  // "DOWN", "CONNECTING", ...

struct SpeedSetting {
  std::int64_t minimum, maximum;  // pulses/s
  int acceleration_ms;

  friend bool operator==(const SpeedSetting&, const SpeedSetting&) = default;
};

struct AxisState {
  bool controllable = false;
  std::optional<std::int64_t> position_pulses;  // command counter, as last read
  std::optional<bool> busy;
  bool armed = false;           // an input can start its motion
  bool foreign_motion = false;  // the axis moves without a request to this gateway
  std::optional<bool> excited;
  bool homed = false;             // homed by this gateway since the device epoch began, and no coordinate was set since
  int homings = 0;                // number of successful mechanical origin returns; each sets the coordinates again
  std::uint32_t status_bits = 0;  // as the controller reports them; the kind knows their meaning
  ConditionBits conditions = 0;   // shown by the status
  std::optional<Scale> scale;
  std::optional<std::int64_t> minimum_speed, maximum_speed;  // pulses/s, as last read or set
  std::optional<int> acceleration_ms;
  std::optional<SpeedSetting> origin_speeds;  // of the mechanical origin return, as last read or set
};

struct State {
  LinkState link = LinkState::down;
  std::string link_problem;  // text for people; empty when up
  std::string vendor, model, serial_number, firmware;
  std::string mode, format;
  std::uint64_t device_epoch = 0;  // raised when the controller may have restarted
  TimePoint epoch_began{};         // time at which device_epoch was last raised
  std::uint64_t frame_epoch = 0;   // raised with device_epoch, and when coordinates were set again
  std::array<AxisState, kAxesMax> axes;
  std::optional<int> outputs;               // as bits from the first output on, as last read or set
  std::optional<Trigger> trigger;           // as last read or set
  bool moving_unknown = false;              // the line was lost while something moved, and nothing was read since
  TimePoint read{};                         // when the positions were last read
  std::vector<Stop> open_stops;             // stops not confirmed yet; oldest first
  std::optional<EmergencyLatch> emergency;  // set while all motion is forbidden
  AxisSet controllable() const;
  AxisState& axis(int number) { return axes[static_cast<std::size_t>(number - 1)]; }
  const AxisState& axis(int number) const { return axes[static_cast<std::size_t>(number - 1)]; }
};

}  // namespace axisgate::stage
