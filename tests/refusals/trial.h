// Trials of a command under a condition: sent directly to the simulated controller, or requested from the gateway.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/refusals/conditions.h"

namespace axisgate::refusals {

// Returns the simulator's answer to the case's line after the condition has become true. If an earlier line is refused,
// returns that line and its answer.
std::string at_simulator(const Condition& condition, const Case& one);

// Moment at which the condition becomes true: as the line is about to reach the controller, or early enough for the
// gateway to notice.
enum class Moment { as_it_arrives, before };

struct Verdict {
  bool ended = false;
  std::optional<Problem> problem;
  std::vector<std::string> answers;
  int sent = 0;  // number of times the line was written
  std::string replay;
};
Verdict at_gateway(const Condition& condition, const Case& one, Moment moment);

// Runs a jog and makes the condition true as JD: is about to reach the controller. Returns the answers to JD: and the
// end of the jog.
Verdict of_a_faster_jog(const Condition& condition);

}  // namespace axisgate::refusals
