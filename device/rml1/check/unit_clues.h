// Clues to the unit in which a job was written: the same numbers are a board in one unit and a relief in another.
#pragma once

#include <cstddef>
#include <optional>
#include <set>

namespace axisgate::rml1 {

// Not thread safe.
class UnitClues {
 public:
  // How deep a path leads, in steps below Z0.
  void deep(double steps);
  // By how much the tool is lifted between cuts, in steps, or to which height above Z0.
  void lifted(double steps);

  // Returns the natural logarithm of how much likelier these depths and lifts are with one step than with the other, by
  // what boards, reliefs and signs usually have. 0 if the job shows neither.
  double odds(double step_mm, double other_mm) const;

 private:
  double likelihood(double step_mm) const;

  static constexpr std::size_t kLevelsOfARelief = 20;

  std::set<double> depths_;     // different ones, in steps, up to those of a relief
  double deepest_ = 0;          // steps; 0: nothing is cut
  std::optional<double> lift_;  // the lowest one, in steps
};

}  // namespace axisgate::rml1
