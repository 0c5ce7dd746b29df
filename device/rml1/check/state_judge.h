// What a job leaves behind in the machine, and what it takes from it without setting it: the next job, or the same one
// on another day, then does something else.
#pragma once

#include <optional>

#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/instruction.h"
#include "device/rml1/machine/leaves.h"
#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// Each is reported once. Not thread safe.
class StateJudge {
 public:
  // Everything referred to outlives this.
  StateJudge(const Profile& profile, Diagnostics& diagnostics) : profile_(profile), diagnostics_(diagnostics) {}

  void executed(const Instruction& instruction);
  void finish(const Machine& machine);

  const Leaves& leaves() const { return leaves_; }

 private:
  void set_surface(const Instruction& instruction);
  void set_revolutions(const Instruction& instruction);
  void turn(const Instruction& instruction);

  const Profile& profile_;
  Diagnostics& diagnostics_;
  Leaves leaves_;
  bool revolutions_reported_ = false;
  Place relative_, dwell_;  // of the last command that set it
};

}  // namespace axisgate::rml1
