// What is known of one controller, published whole at every change.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/core/quantity.h"
#include "device/core/time.h"
#include "device/stage/axes.h"
#include "device/stage/stop.h"
#include "device/stage/trigger.h"

namespace axisgate::stage {

enum class LinkState {
  down,        // no line, or nobody answers
  connecting,  // open; the handshake runs
  up,          // the configured controller answers
  doubtful,    // the barrier runs after a time limit or garbage
  babbling,    // the device sends without end; the line is shut, and opened again from time to time
};
std::string_view name(LinkState state);  // "DOWN", "CONNECTING", ...

// Manual 14 of Q:S, bits numbered from 1 as there.
struct AxisStatusBits {
  std::uint32_t raw = 0;

  bool bit(int number) const { return (raw >> (number - 1)) & 1u; }
  bool emergency() const { return bit(6); }
  bool cw_limit() const { return bit(20); }
  bool ccw_limit() const { return bit(21); }
};

// S and F in pulses/s, 1 to 1,000,000, and R in ms, 1 to 1,000 (manual 89), 94)).
struct SpeedSetting {
  std::int64_t minimum, maximum;
  int acceleration_ms;

  friend bool operator==(const SpeedSetting&, const SpeedSetting&) = default;
};

struct AxisState {
  bool controllable = false;
  std::optional<std::int64_t> position_pulses;  // command counter, as last read
  std::optional<bool> busy;
  bool armed = false;           // WI: was accepted there: an input pin starts what is set (manual 58))
  bool foreign_motion = false;  // it moves, and nobody asked the gateway for that
  std::optional<bool> excited;
  bool homed = false;  // by this gateway since the device epoch began, and no coordinate was set since
  int homings = 0;     // mechanical origin returns seen to succeed: each sets its coordinates again
  AxisStatusBits status;
  std::optional<Scale> scale;
  std::optional<std::int64_t> minimum_speed, maximum_speed;  // S and F in pulses per second, as last read or set
  std::optional<int> acceleration_ms;                        // R
  std::optional<SpeedSetting> origin_speeds;                 // of the mechanical origin return, likewise
};

struct State {
  LinkState link = LinkState::down;
  std::string link_problem;  // for a person; empty when up
  std::string vendor, model, serial_number, firmware;
  std::string mode, format;
  std::uint64_t device_epoch = 0;  // raised when the controller may have restarted
  TimePoint epoch_began{};         // when that was last seen
  std::uint64_t frame_epoch = 0;   // raised with it, and when coordinates were set again: R: RC: PSET:
  std::array<AxisState, kAxisCount> axes;
  std::optional<int> outputs;               // OUT1 to OUT6 as bits 0 to 5, as last read or set (manual 26), 96))
  std::optional<Trigger> trigger;           // as last read or set
  bool moving_unknown = false;              // the line was lost while something moved and nothing was read since
  TimePoint read{};                         // when the positions were last read
  std::vector<Stop> open_stops;             // not seen to be obeyed yet; oldest first
  std::optional<EmergencyLatch> emergency;  // while all motion is forbidden
  AxisSet controllable() const;
  AxisState& axis(int number) { return axes[static_cast<std::size_t>(number - 1)]; }
  const AxisState& axis(int number) const { return axes[static_cast<std::size_t>(number - 1)]; }
};

}  // namespace axisgate::stage
