// Clues to the unit in which a job was written: the same numbers are a board in one unit and a relief in another.
#pragma once

#include <cstddef>
#include <optional>
#include <set>

namespace axisgate::rml1 {

// Not thread safe.
class UnitClues {
 public:
  // Takes the depth of a path, in steps below Z0.
  void deep(double steps);
  // Takes a lift of the tool between cuts in steps, or its height above Z0.
  void lifted(double steps);

  // Returns the natural logarithm of the odds of the first step against the other, given these depths and lifts, and
  // the usual ones of boards, reliefs and signs. 0 if the job has neither.
  double odds(double step_mm, double other_mm) const;

 private:
  double likelihood(double step_mm) const;

  static constexpr std::size_t kLevelsOfARelief = 20;

  std::set<double> depths_;     // different depths in steps; at most one more than kLevelsOfARelief
  double deepest_ = 0;          // steps; 0: nothing is cut
  std::optional<double> lift_;  // the lowest one, in steps
};

}  // namespace axisgate::rml1
