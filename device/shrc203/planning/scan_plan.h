// What a scan comes to: one axis over a range at constant speed, with pulses at the trigger output (manual 98) T:P,
// 101) T:E). The controller compares no positions: it counts pulses from the arming on.
//
//   run_from ──── speeds up ──── from ════ constant speed ════ to ──── slows down ──── run_to
//       armed         T        T     T     T     T     T     T    T                      disarmed at READY
#pragma once

#include <optional>

#include "device/core/problem.h"
#include "device/shrc203/command/trigger.h"
#include "device/shrc203/planning/path_plan.h"
#include "device/shrc203/stage.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

// Above it pulses may be missing (manual 98), 101): "set the operating speed ... to 56 kpps or less").
inline constexpr std::int64_t kTriggeredSpeedMax = 56'000;

struct ScanPlan {
  PathPlan path;  // to where the run starts, unless the axis is there, and the run
  Trigger trigger;
  ScanResult due;
};

// What the envelope refuses for the whole run; invalid_request for a range without length; out_of_range; too_fast above
// kTriggeredSpeedMax. `scale_pulse`: what one pulse of the axis's scale is, in the unit of its Scale (manual 9) ?:R).
Result<ScanPlan> plan_scan(const ScanRequest& request, const Positions& from, std::optional<Decimal> scale_pulse,
                           const Envelope& envelope);

// How many trigger pulses a counter gives on a way of so many pulses.
inline std::int64_t triggers_on(std::int64_t way, const Trigger& trigger) {
  return (way < 0 ? -way : way) / trigger.interval;
}

}  // namespace axisgate::shrc203
