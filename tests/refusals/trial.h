// A command under a condition: sent directly to the simulated controller, and requested from the gateway over one.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tests/refusals/conditions.h"

namespace axisgate::refusals {

// What the simulator answers to the case's line, the condition having struck; or what of the lines before it refused.
std::string at_simulator(const Condition& condition, const Case& one);

// When the condition strikes: as the line is about to reach the controller, or so long before that the gateway has
// seen what there is to be seen.
enum class Moment { as_it_arrives, before };

struct Verdict {
  bool ended = false;
  std::optional<Problem> problem;
  std::vector<std::string> answers;
  int sent = 0;  // how often the line was written
  std::string replay;
};
Verdict at_gateway(const Condition& condition, const Case& one, Moment moment);

// Of a jog that runs when the condition strikes, as JD: is about to reach the controller: its answers, and the jog's
// end.
Verdict of_a_faster_jog(const Condition& condition);

}  // namespace axisgate::refusals
