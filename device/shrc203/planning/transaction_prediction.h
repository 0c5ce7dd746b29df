// Predicts where a caller's own lines move the axes, and how fast, and checks this against the caller's envelope before
// sending.
#pragma once

#include <map>
#include <vector>

#include "device/shot/command/command.h"
#include "device/shot/command/reply.h"
#include "device/shrc203/planning/arc.h"
#include "device/shrc203/planning/plan.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

class TransactionPrediction {
 public:
  // Starts the prediction at the positions `at` with the `speeds` set, by axis.
  TransactionPrediction(const Envelope& envelope, const Positions& at, std::map<int, SpeedSetting> speeds,
                        AxisSet controllable)
      : envelope_(envelope), at_(at), speeds_(std::move(speeds)), controllable_(controllable) {}

  // Adds the next line. Fails as the envelope does; with invalid_request if the line's target cannot be predicted.
  Result<void> add(const Command& command);
  // Adds a move to a saved position; each controllable axis moves independently at its own speed. Fails as the envelope
  // does.
  Result<void> go_to(const Positions& place);
  // Returns the predicted positions; nullopt for an axis whose position cannot be predicted.
  const Positions& at() const { return at_; }

 private:
  struct Pending {
    Register reg = Register::none;
    bool relative = false;
    bool lasting = false;  // GC: does not delete it
    std::int64_t amount = 0;
    Extent extent = {};  // part of the displacement that must lie within the travel: the end, or all of a curve
    int paced_by = 0;    // for a line or curve: the axis whose S is the path speed
    double share = 1;    // highest share of the path speed on this axis
  };
  Result<void> add_speeds(const Command& command);
  Result<void> add_motion(const Command& command);
  Result<void> add_setting(const Command& command);
  Result<void> add_arc(const Command& command);
  Result<void> add_pending(int axis, const Pending& pending);
  Result<void> overwrite(Register reg, bool lasting);
  Result<void> check_chain(int axis);
  AxisSet axes_of(Register reg) const;  // axes on which the register is set
  void drop(int axis, Register reg);
  void delete_settings(AxisSet axes);
  Result<void> check_extent(int axis, const Extent& extent, std::int64_t end);
  Result<void> add_origin_return(const Command& command);
  Result<void> add_program();
  Result<void> start(int axis);

  Envelope envelope_;
  Positions at_;
  std::map<int, SpeedSetting> speeds_;
  AxisSet controllable_;
  std::map<int, std::vector<Pending>> pending_;  // motions that a G would start, by axis
  AxisSet started_;
  AxisSet uncertain_;  // axes whose setting may have been dropped
};

}  // namespace axisgate::shrc203
