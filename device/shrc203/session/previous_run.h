// What a run of the gateway that was killed had started, and nobody had stopped: it is stopped as soon as the
// controller says that nobody else has used the line since, or finishes.
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
  // A line has come in on the first connect. If it is the answer to ?:CMD (manual 40)) and names a line of that run,
  // the stop is asked for now, before any other question.
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
};

}  // namespace axisgate::shrc203
