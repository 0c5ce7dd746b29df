// Where a path is: one enum, changed in one place by the table of README.md, and the number of the segment that runs.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace axisgate::shrc203 {

enum class SegmentPhase {
  stationary,  // nothing runs, and nothing is set: also before the first
  setting,     // a segment is set and started
  running,     // it runs, and the prebuffer is empty
  refilling,   // and the next one's setpoint is on its way
  chained,     // and the next one waits in the prebuffer
  doubtful,    // nobody knows which one runs: the counters tell at READY
};
inline constexpr std::size_t kSegmentPhases = 6;

enum class SegmentEvent {
  set_asked,  // the next one's setpoint goes out, while the axes are stationary
  start_accepted,
  start_doubted,
  refill_asked,
  refill_accepted,    // OK_D
  refill_doubted,     // OK, when the chain has ended (an underrun); no answer; NG
  ended,              // and the one in the prebuffer runs
  became_stationary,  // ended, with nothing after it
  found,              // the counters have shown which one was the last to run
};
inline constexpr std::size_t kSegmentEvents = 9;

std::string_view name(SegmentPhase phase);  // "stationary", as in README.md
std::string_view name(SegmentEvent event);
// The phase after the event; nothing where the table has none.
std::optional<SegmentPhase> next(SegmentPhase phase, SegmentEvent event);

}  // namespace axisgate::shrc203
