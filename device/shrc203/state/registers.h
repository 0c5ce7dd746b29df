// The settings that a G may start (manual 85)): what is left over in them would run on somebody else's G.
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
  // In the order in which they are asked for.
  static std::span<const Register> all();

  // After a connect, foreign traffic, a set or a go in doubt, a stop: nobody knows.
  void forget();
  bool known() const { return known_; }

  // One's own answers to the questions of all(). Several may read at once, and what one has heard is not another's.
  class Reading {
   public:
    void take(Register reg, const Reply& reply, AxisSet controllable);
    // The axes on which anything that was asked for is set.
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

  // Left over in what GC: deletes (manual 87)): M, A, E and K.
  AxisSet clearable() const;
  // Left over in what no command is documented to clear: the prebuffers, WT:, WI: and J:.
  AxisSet lasting() const;
  void cleared(AxisSet axes);

 private:
  bool known_ = false;
  std::uint64_t forgotten_ = 0;  // times
  std::map<Register, AxisSet> set_;
};

// The amounts that an axis question (?:MP ...) tells, by axis; nothing for NS.
std::optional<std::int64_t> amount_of(const Reply& reply, int axis, AxisSet controllable);

// Whether a register holds what `setter` wrote, or nothing, or something else, by the answer to the register's
// question.
enum class Held { as_set, nothing, other };
Held held(const Reply& reply, const Command& setter, AxisSet controllable);

}  // namespace axisgate::shrc203
