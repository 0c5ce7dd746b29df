// The life of a stop: one enum, changed in one place by the table of README.md.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "device/shrc203/stage.h"
#include "device/stage/stage_controller.h"

namespace axisgate::shrc203 {

enum class StopPhase {
  writing,        // its L: is not answered yet: the same stop by others joins it
  slowing,        // waits until the axes are stationary
  slowing_again,  // they ran on, or may have started again: it was written once more
  ended,          // its report is complete
};
inline constexpr std::size_t kStopPhases = 4;

enum class StopEvent {
  answered,  // its L: was, and the axes can be looked at
  refused,   // it was not written, or nobody can look at the axes
  ran_on,
  finished,  // the axes are stationary, or the wait for that has run out
};
inline constexpr std::size_t kStopEvents = 4;

std::string_view name(StopPhase phase);  // "writing", as in README.md
std::string_view name(StopEvent event);
// The phase after the event; nothing where the table has none.
std::optional<StopPhase> next(StopPhase phase, StopEvent event);

enum class StopKind { stop, emergency };  // L:, L:E

struct StopJob {
  AxisSet axes;
  StopKind kind = StopKind::stop;
  StopPhase phase = StopPhase::writing;  // changed by Stops::change() alone
  RequestContext context;
  std::vector<StageController::OnStopped> done;  // empty ones have been answered
  StopReport report;
  bool stationary = false;  // the last reading showed it

  AxisSet stops() const { return kind == StopKind::emergency ? AxisSet::all() : axes; }
};
using StopJobPtr = std::shared_ptr<StopJob>;

}  // namespace axisgate::shrc203
