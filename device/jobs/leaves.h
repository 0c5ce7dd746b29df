// Leaves are settings that a job leaves in the machine. DF and IN do not reset them, and no later command can restore
// them, because their previous values are unknown.
#pragma once

namespace axisgate::jobs {

struct Leaves {
  bool surface = false;      // Z0 (guideline 3-3 !ZO)
  bool revolutions = false;  // the spindle speed, if the machine has more than one (3-3 !RC)
  bool rotation = false;     // the position of the axis of rotation (3-3 !ZE)
  bool tool = false;         // the tool, if the mill takes J as a tool change (beyond the guideline)

  Leaves& operator|=(const Leaves& other) {
    surface |= other.surface;
    revolutions |= other.revolutions;
    rotation |= other.rotation;
    tool |= other.tool;
    return *this;
  }
  friend bool operator==(const Leaves&, const Leaves&) = default;
};

}  // namespace axisgate::jobs
