// Where a caller's own lines would move the axes, and how fast: checked against the caller's envelope before sending.
#pragma once

#include <map>
#include <vector>

#include "device/shrc203/command/codec.h"
#include "device/shrc203/command/reply.h"
#include "device/shrc203/planning/plan.h"
#include "device/stage/arc.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

class TransactionPrediction {
 public:
  // From where the axes are and how fast they are set, by axis.
  TransactionPrediction(const Envelope& envelope, const Positions& at, std::map<int, SpeedSetting> speeds,
                        AxisSet controllable)
      : envelope_(envelope), at_(at), speeds_(std::move(speeds)), controllable_(controllable) {}

  // The next line. What the envelope refuses; invalid_request where nobody can tell where it would lead.
  Result<void> add(const Command& command);
  // To a saved position, each controllable axis by itself at its own speed. What the envelope refuses.
  Result<void> go_to(const Positions& place);
  // Where the axes are then; nothing where that is not known.
  const Positions& at() const { return at_; }

 private:
  struct Pending {
    Register reg = Register::none;
    bool relative = false;
    bool lasting = false;  // GC: does not delete it
    std::int64_t amount = 0;
    Extent extent = {};  // of its way, what has to lie within the travel: the end, or all of a curve
    int paced_by = 0;    // of a line or curve: the axis whose S it runs at
    double share = 1;    // of that speed, what this axis makes at most
  };
  Result<void> add_speeds(const Command& command);
  Result<void> add_motion(const Command& command);
  Result<void> add_setting(const Command& command);
  Result<void> add_arc(const Command& command);
  Result<void> add_pending(int axis, const Pending& pending);
  Result<void> overwrite(Register reg, bool lasting);
  Result<void> check_chain(int axis);
  AxisSet axes_of(Register reg) const;  // on which it is set
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
  std::map<int, std::vector<Pending>> pending_;  // by axis, what a G would start
  AxisSet started_;
  AxisSet uncertain_;  // what was set there may have been dropped
};

}  // namespace axisgate::shrc203
