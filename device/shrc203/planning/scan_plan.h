// A scan: one axis runs over a range at constant speed, with pulses at the trigger output (manual 98) T:P, 101) T:E).
// The controller compares no positions: it counts pulses from the moment the trigger is armed.
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

// Highest speed in pulses/s without missing trigger pulses (manual 98), 101): "set the operating speed ... to 56 kpps
// or less").
inline constexpr std::int64_t kTriggeredSpeedMax = 56'000;

struct ScanPlan {
  PathPlan path;  // move to the start of the run, unless the axis is there already, then the run
  Trigger trigger;
  ScanResult due;
};

// Plans a scan. `scale_pulse`: length of one scale pulse of the axis, in the unit of its Scale (manual 9) ?:R). Fails
// as the envelope does for the whole run; with invalid_request for a range without length; with out_of_range; with
// too_fast above kTriggeredSpeedMax.
Result<ScanPlan> plan_scan(const ScanRequest& request, const Positions& from, std::optional<Decimal> scale_pulse,
                           const Envelope& envelope);

// Returns the number of trigger pulses over a distance of that many pulses.
inline std::int64_t triggers_on(std::int64_t way, const Trigger& trigger) {
  return (way < 0 ? -way : way) / trigger.interval;
}

}  // namespace axisgate::shrc203
