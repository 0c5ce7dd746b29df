// Motions of an earlier run of the gateway that was killed. They are stopped, or may finish, as soon as the controller
// shows that no other program has used the line since.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/shot/command/axes.h"
#include "device/shot/command/reply.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/state_store.h"
#include "device/stage/unfinished.h"

namespace axisgate::shrc203 {

class PreviousRun {
 public:
  PreviousRun(Stops& stops, StateStore& store) : stops_(stops), store_(store) {}

  // Takes over the unfinished motions. Call before the line is opened.
  void inherit(std::optional<stage::Unfinished> unfinished) { unfinished_ = std::move(unfinished); }
  // Called for each line received during the first connect. Requests the stop at once, before any other question, if
  // the line is one of that run's lines, as the reply to ?:CMD (manual 40)), or the identity of the same unit and no
  // reply was another program's line.
  void heard(std::string_view text);
  // Decides once about the unfinished motions, when a controller was identified. They are left alone if another unit
  // answers, or `line_before` is another program's line. `line_before` is nullopt if the controller did not report it.
  void identified(const Identity& identity, const std::optional<std::string>& line_before);
  // Called when all axes were seen stationary.
  void all_stationary();

 private:
  bool is_ours(std::string_view line_before) const;
  void take_over();

  Stops& stops_;
  StateStore& store_;
  std::optional<stage::Unfinished> unfinished_;  // kept until all axes are stationary
  bool names_another_ = false;                   // ?:CMD was answered by another program's line
};

}  // namespace axisgate::shrc203
