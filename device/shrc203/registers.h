// The settings that a G may start (manual 85)): what is left over in them would run on somebody else's G.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

#include "device/shrc203/axes.h"
#include "device/shrc203/codec.h"
#include "device/shrc203/command_table.h"
#include "device/shrc203/reply.h"

namespace axisgate::shrc203 {

class Registers {
 public:
  // The questions that tell of them all, in the order in which they are asked.
  static const std::vector<std::string_view>& questions();

  // After a connect, foreign traffic, a set or a go in doubt, a stop: nobody knows.
  void forget();
  bool known() const { return known_; }

  // One's own answers to questions(). Several may read at once, and what one has heard is not another's.
  class Reading {
   public:
    void take(std::string_view question, const Reply& reply, AxisSet controllable);
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

std::string_view name(Register reg);
// What tells what it holds: "?:MP".
std::string_view question_of(Register reg);

}  // namespace axisgate::shrc203
