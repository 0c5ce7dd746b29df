// State machine of a stop: one enum (stage::StopState), changed in one place by the table of README.md.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "device/shrc203/stage.h"
#include "device/stage/stage_controller.h"

namespace axisgate::shrc203 {

enum class StopEvent {
  wrote,                // its line is about to be sent, for the first time or again
  seen_stationary,      // a reading that began after the write showed its axes stationary and their prebuffers empty
  returned_stationary,  // the controller took no stop in its mode, and its axes were stationary when it was back in
                        // HOST
  widened,              // a wider stop includes it
  abandoned,            // an administrator withdraws it
};
inline constexpr std::size_t kStopEvents = 5;

std::string_view name(StopEvent event);  // "wrote", as in README.md
// Returns the state after the event; nullopt if the table has no such transition.
std::optional<StopState> next(StopState state, StopEvent event);

// A StopJob is a stop and the callers who wait for it.
struct StopJob {
  struct Caller {
    AxisSet axes;  // axes that this caller named
    TimePoint asked{};
    std::optional<TimePoint> answer_by{};
    StageController::OnStopped done;  // empty once answered
  };

  AxisSet excluded() const { return stop.kind == StopKind::emergency ? kAllAxes : stop.axes; }
  bool open() const { return is_open(stop.state); }

  Stop stop;               // its state is changed by OpenStops only
  RequestContext context;  // the first caller's
  std::vector<Caller> callers;
  StopReport report;           // report for all its axes
  TimePoint write_at{};        // TimePoint::max(): wait until a line is received
  bool taken = false;          // the newest write was certainly received, so one READY is enough
  bool named_several = false;  // the newest write names several axes and is not answered; NG may be due to one of them
  bool kept_waiting = false;   // the mode took no stop: it is written only if an axis is busy on the return to HOST
  bool stationary = false;     // the newest reading showed the axes stationary
  int stationary_looks = 0;    // readings in a row that showed it
  TimePoint rest_since{};      // time of the first of these readings
  int kept_looks = 0;          // readings that showed a segment in a prebuffer of stationary axes
};
using StopJobPtr = std::shared_ptr<StopJob>;

}  // namespace axisgate::shrc203
