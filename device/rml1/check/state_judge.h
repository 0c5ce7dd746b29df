// Settings that a job leaves in the machine, and settings that it uses without setting them: they change what the next
// job does, or the same job on another day.
#pragma once

#include <optional>

#include "device/jobs/leaves.h"
#include "device/rml1/language/diagnostic.h"
#include "device/rml1/language/instruction.h"
#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// Each is reported once. Not thread safe.
class StateJudge {
 public:
  // The referenced objects must outlive this one.
  StateJudge(const Profile& profile, Diagnostics& diagnostics) : profile_(profile), diagnostics_(diagnostics) {}

  void executed(const Instruction& instruction);
  void finish(const Machine& machine);

  const jobs::Leaves& leaves() const { return leaves_; }

 private:
  void set_surface(const Instruction& instruction);
  void set_revolutions(const Instruction& instruction);
  void turn(const Instruction& instruction);

  const Profile& profile_;
  Diagnostics& diagnostics_;
  jobs::Leaves leaves_;
  bool revolutions_reported_ = false;
  jobs::Place relative_, dwell_;  // places of the last commands that set them
};

}  // namespace axisgate::rml1
