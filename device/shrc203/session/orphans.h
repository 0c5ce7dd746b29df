// Motions of the gateway's that nobody waits for any more: jogs that were running when the line was lost, and what a
// run of the gateway that was killed had started. They are stopped as soon as a controller answers, or finish.
#pragma once

#include <optional>
#include <string>

#include "device/shrc203/command/axes.h"
#include "device/shrc203/command/reply.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/state_store.h"
#include "device/stage/unfinished.h"

namespace axisgate::shrc203 {

class Orphans {
 public:
  Orphans(Stops& stops, StateStore& store) : stops_(stops), store_(store) {}

  void add_jogs(AxisSet axes) { axes_ = axes_ | axes; }
  // Before the line is opened.
  void inherit(stage::Unfinished unfinished) { unfinished_ = std::move(unfinished); }
  // A controller has answered: what was inherited is judged, once. It is the gateway's where the controller is the same
  // and was last sent what that run wrote last (manual 40) ?:CMD); otherwise it is left alone. `line_before`: nothing
  // where that is not known.
  void identified(const Identity& identity, const std::optional<std::string>& line_before);
  // Again and again, until everything was seen to be stationary.
  void stop();
  void all_stationary();

 private:
  bool is_ours(const Identity& identity, const std::optional<std::string>& line_before) const;

  Stops& stops_;
  StateStore& store_;
  AxisSet axes_;                                 // to be stopped
  std::optional<stage::Unfinished> unfinished_;  // until everything is stationary
};

}  // namespace axisgate::shrc203
