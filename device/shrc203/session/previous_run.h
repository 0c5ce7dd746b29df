// This file handles the motions of an earlier run of the gateway that was killed. They are stopped, or may finish, as
// soon as the controller says that nobody else has used the line since.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/shrc203/command/axes.h"
#include "device/shrc203/command/reply.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/state_store.h"
#include "device/stage/unfinished.h"

namespace axisgate::shrc203 {

class PreviousRun {
 public:
  PreviousRun(Stops& stops, StateStore& store) : stops_(stops), store_(store) {}

  // Before the line is opened.
  void inherit(std::optional<stage::Unfinished> unfinished) { unfinished_ = std::move(unfinished); }
  // A line has come in on the first connect. If it answers ?:CMD (manual 40)) with a line of that run, or is the
  // identity of the same unit and no answer named another program's line, the stop is requested now, before any other
  // question.
  void heard(std::string_view text);
  // A controller has answered: what was inherited is judged, once. It is left alone if another unit answers, or
  // `line_before` is another program's; nullopt if the controller did not say.
  void identified(const Identity& identity, const std::optional<std::string>& line_before);
  // Everything was seen to be stationary.
  void all_stationary();

 private:
  bool is_ours(std::string_view line_before) const;
  void take_over();

  Stops& stops_;
  StateStore& store_;
  std::optional<stage::Unfinished> unfinished_;  // until everything is stationary
  bool names_another_ = false;                   // ?:CMD was answered by another program's line
};

}  // namespace axisgate::shrc203
