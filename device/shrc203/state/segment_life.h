// State machine of a path: one enum, changed in one place by the table of README.md.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace axisgate::shrc203 {

enum class SegmentPhase {
  stationary,  // no segment runs or is set; also before the first one
  setting,     // a segment is set and started
  running,     // a segment runs, and the prebuffer is empty
  refilling,   // a segment runs, and the next one's setpoint is in flight
  chained,     // a segment runs, and the next one is in the prebuffer
  doubtful,    // the running segment is unknown; the counters show it at READY
};
inline constexpr std::size_t kSegmentPhases = 6;

enum class SegmentEvent {
  set_asked,  // the next segment's setpoint is about to be sent, while the axes are stationary
  start_accepted,
  start_doubted,
  refill_asked,
  refill_accepted,    // OK_D
  refill_doubted,     // OK, if the chain has ended (an underrun); no reply; NG
  ended,              // the segment has ended, and the one in the prebuffer runs
  became_stationary,  // the segment has ended, with none after it
  found,              // the counters have shown the last segment that ran
};
inline constexpr std::size_t kSegmentEvents = 9;

std::string_view name(SegmentPhase phase);  // "stationary", as in README.md
std::string_view name(SegmentEvent event);
// Returns the phase after the event; nullopt if the table has no such transition.
std::optional<SegmentPhase> next(SegmentPhase phase, SegmentEvent event);

}  // namespace axisgate::shrc203
