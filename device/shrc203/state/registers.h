// The settings that a G may start (manual 85)): a stale setpoint in them would run on somebody else's G.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "device/shrc203/command/axes.h"
#include "device/shrc203/command/codec.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/command/reply.h"

namespace axisgate::shrc203 {

class Registers {
 public:
  // In the order of their questions.
  static std::span<const Register> all();

  // After a connect, foreign traffic, a set or a go in doubt, a stop: nobody knows.
  void forget();
  bool known() const { return known_; }

  // The answers of one reader to the questions of all(). Several may read at once, each with its own answers.
  class Reading {
   public:
    void take(Register reg, const Reply& reply, AxisSet controllable);
    // The axes on which any register that was read is set.
    AxisSet set() const;

   private:
    friend class Registers;
    explicit Reading(std::uint64_t begun) : begun_(begun) {}
    std::uint64_t begun_;  // forgotten so often then
    std::map<Register, AxisSet> set_;
  };
  Reading begin_reading() const { return Reading(forgotten_); }
  // All questions were answered. What was forgotten meanwhile is not known for that.
  void end_reading(Reading reading);

  // The axes on which one of these is set.
  AxisSet set_in(Register reg) const;
  bool any() const;

  // The axes with a stale setpoint that GC: deletes (manual 87)): in M, A, E or K.
  AxisSet clearable() const;
  // The axes with one that no command is documented to clear: in the prebuffers, WT:, WI: or J:.
  AxisSet lasting() const;
  // GC: for these axes was accepted. A line or curve is gone only if they hold all of its axes: nobody knows what
  // becomes of it otherwise (manual 87)).
  void cleared(AxisSet axes);

 private:
  bool known_ = false;
  std::uint64_t forgotten_ = 0;  // times
  std::map<Register, AxisSet> set_;
};

// The amount that an axis question (?:MP ...) reports for the axis; nothing for NS.
std::optional<std::int64_t> amount_of(const Reply& reply, int axis, AxisSet controllable);

// Whether a register holds what `setter` wrote, or nothing, or something else, by the answer to the register's
// question.
enum class Held { as_set, nothing, other };
Held held(const Reply& reply, const Command& setter, AxisSet controllable);

}  // namespace axisgate::shrc203
