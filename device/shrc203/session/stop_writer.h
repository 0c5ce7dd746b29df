// Writing of open stops: in their turn on a line that answers, and without waiting for replies if it is unknown whether
// the line answers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/open_stops.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class StopWriter {
 public:
  StopWriter(Dialogue& dialogue, const Line& line, StateStore& store, OpenStops& open, const NonHost& non_host,
             const Tasks& tasks)
      : dialogue_(dialogue), line_(line), store_(store), open_(open), non_host_(non_host), tasks_(tasks) {}

  // Implements LineListener::stops_to_write(). Each open stop is due when the port opens, and again after the first
  // line that is received. After NG to several axes each axis is stopped alone, since one motor may be off (manual
  // 65)).
  std::vector<ExchangeRequest> lines_due(std::string_view heard);
  // Called when a barrier begins on an open port: the next line counts as the first again.
  void barrier_entered() { heard_ = false; }
  // Called when another unit is at the line; it must not receive any stop.
  void other_unit_answered() { other_unit_ = true; }
  // Make a stop that was written without a reply due again: the line answers now, or was closed.
  void line_answers();
  void line_lost();

  // Reports whether the controller accepts no stop in its present mode (manual 111), 117); section 4, last note).
  bool takes_none() const;
  bool can_write() const { return line_.state().port_open() && !takes_none() && !other_unit_; }
  // Writes the stop, and notes the controller's reply in its report.
  Task<void> write(StopJobPtr job);
  // Returns the time that the axes of a stop need to slow down (manual 89) D:).
  Duration slowing(AxisSet axes) const;

 private:
  AxisSet excited(const StopJob& job) const;
  Command command_for(const StopJob& job, AxisSet axes) const;
  ExchangeRequest request_for(const StopJob& job, Command command) const;
  void write_blindly(const StopJobPtr& job, bool alone, std::vector<ExchangeRequest>& lines);
  Task<void> write_one_at_a_time(StopJobPtr job);
  void note_result(StopJob& job, AxisSet named, const ExchangeResult& result) const;

  Dialogue& dialogue_;
  const Line& line_;
  StateStore& store_;
  OpenStops& open_;
  const NonHost& non_host_;
  const Tasks& tasks_;
  bool heard_ = false;  // a line was received since the port was opened, or since the barrier began
  bool other_unit_ = false;
};

}  // namespace axisgate::shrc203
