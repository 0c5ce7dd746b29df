// Output of the parser.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "device/jobs/place.h"
#include "device/rml1/language/instruction_table.h"

namespace axisgate::rml1 {

// Target of one axis in a group of !ZE.
struct AxisTarget {
  char letter = 'X';   // a capital
  double value = 0;    // coordinate, or angle
  bool point = false;  // written with a decimal point
  jobs::Place place;   // place of the letter
};

// One command, or one parameter set of it: PD with three points is reported three times, PD without points once.
struct Instruction {
  const Row* row = nullptr;
  jobs::Place place;                  // place of the command's first byte
  bool first = true;                  // first set of the command
  std::uint8_t count = 0;             // number of parameters
  std::array<bool, 4> given = {};     // false for a parameter in error, among the first `count`
  std::array<double, 4> values = {};  // values within the parameters' ranges
  std::array<jobs::Place, 4> places = {};
  std::span<const AxisTarget> axes;  // !ZE: each letter once, at least one; valid during the call
  std::uint64_t end = 0;             // number of bytes of the job that must arrive before it can be executed
};

// Returns the place where the command, or this set of its coordinates, begins.
inline const jobs::Place& begin_of(const Instruction& instruction) {
  if (instruction.first) return instruction.place;
  return instruction.axes.empty() ? instruction.places[0] : instruction.axes.front().place;
}

class InstructionListener {
 public:
  virtual ~InstructionListener() = default;
  virtual void execute(const Instruction& instruction) = 0;
};

}  // namespace axisgate::rml1
