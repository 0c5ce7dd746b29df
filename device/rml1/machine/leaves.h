// What a job sets in a machine that DF and IN do not give back, and no later command can: its value before is not
// known.
#pragma once

namespace axisgate::rml1 {

struct Leaves {
  bool surface = false;      // Z0 (guideline 3-3 !ZO)
  bool revolutions = false;  // the spindle speed, where the machine has one to set (3-3 !RC)
  bool rotation = false;     // where the axis of rotation is (3-3 !ZE)
  bool tool = false;         // which tool is in, where a mill takes J as its change (beyond the guideline)

  Leaves& operator|=(const Leaves& other) {
    surface |= other.surface;
    revolutions |= other.revolutions;
    rotation |= other.rotation;
    tool |= other.tool;
    return *this;
  }
  friend bool operator==(const Leaves&, const Leaves&) = default;
};

}  // namespace axisgate::rml1
