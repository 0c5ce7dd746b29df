// Contents of the registers that a G: may start (manual 85)): another caller's G: would run a stale setpoint in them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "device/shot/command/axes.h"
#include "device/shot/command/command.h"
#include "device/shot/command/reply.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {

class Registers {
 public:
  // Returns all registers, in the order of their questions.
  static std::span<const Register> all();

  // Makes the contents unknown: after a connect, foreign traffic, a setting or G: in doubt, or a stop.
  void forget();
  bool known() const { return known_; }

  // A Reading is one reader's replies to the questions of all(). Several readers may read at once, each with its own
  // replies.
  class Reading {
   public:
    void take(Register reg, const Reply& reply, AxisSet controllable);
    // Returns the axes on which any of the registers read is set.
    AxisSet set() const;

   private:
    friend class Registers;
    explicit Reading(std::uint64_t begun) : begun_(begun) {}
    std::uint64_t begun_;  // value of forgotten_ at the beginning
    std::map<Register, AxisSet> set_;
  };
  Reading begin_reading() const { return Reading(forgotten_); }
  // Takes over the contents when all questions were answered. They stay unknown if forget() was called meanwhile.
  void end_reading(Reading reading);

  // Returns the axes on which the register is set.
  AxisSet set_in(Register reg) const;
  bool any() const;

  // Returns the axes with a stale setpoint that GC: deletes (manual 87)): in M, A, E or K.
  AxisSet clearable() const;
  // Returns the axes with a stale setpoint that no command is documented to clear: in the prebuffers, WT:, WI: or J:.
  AxisSet lasting() const;
  // Called when GC: for these axes was accepted. A line or curve is cleared only if `axes` includes all of its axes;
  // otherwise the result is unknown (manual 87)).
  void cleared(AxisSet axes);

 private:
  bool known_ = false;
  std::uint64_t forgotten_ = 0;  // number of calls of forget()
  std::map<Register, AxisSet> set_;
};

// Returns the amount that an axis question (?:MP ...) reports for the axis; nullopt for NS.
std::optional<std::int64_t> amount_of(const Reply& reply, int axis, AxisSet controllable);

// Content of a register according to the reply to its question: what `setter` wrote, nothing, or something else.
enum class Held { as_set, nothing, other };
Held held(const Reply& reply, const Command& setter, AxisSet controllable);

}  // namespace axisgate::shrc203
