// What the parser hands on.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "device/rml1/language/instruction_table.h"
#include "device/rml1/language/place.h"

namespace axisgate::rml1 {

// One axis of a group of !ZE.
struct AxisTarget {
  char letter = 'X';   // a capital
  double value = 0;    // coordinate, or angle
  bool point = false;  // it was written with a decimal point
  Place place;         // of the letter
};

// A command, or one set of it: PD with three points comes three times, PD without any once.
struct Instruction {
  const Row* row = nullptr;
  Place place;                        // of the command's first byte
  bool first = true;                  // of the command's sets
  std::uint8_t count = 0;             // of parameters
  std::array<bool, 4> given = {};     // of the first `count`: false in error
  std::array<double, 4> values = {};  // within their range
  std::array<Place, 4> places = {};
  std::span<const AxisTarget> axes;  // !ZE: each letter once, at least one; valid during the call
  std::uint64_t end = 0;             // bytes of the job that had to come before it could be executed
};

// Of the command, or of that set of its coordinates.
inline const Place& begin_of(const Instruction& instruction) {
  if (instruction.first) return instruction.place;
  return instruction.axes.empty() ? instruction.places[0] : instruction.axes.front().place;
}

class InstructionListener {
 public:
  virtual ~InstructionListener() = default;
  virtual void execute(const Instruction& instruction) = 0;
};

}  // namespace axisgate::rml1
