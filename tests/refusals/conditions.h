// Conditions under which the controller may answer NG according to the manual, and the gateway's expected problems.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "tests/refusals/manual.h"
#include "tests/simulation/world.h"

namespace axisgate::refusals {

using Device = shrc203::simulator::Simulator;

// A Case is one command under one condition.
struct Case {
  const Sentence* sentence = nullptr;
  std::string line;        // line that is refused
  Lines whole;             // transaction that contains the line
  Lines simulator_before;  // lines that are sent to the simulator first; each must be accepted
  Reason reason = Reason::unspecified;
};

struct Condition {
  std::string name;    // heading on the page
  std::string manual;  // the manual's words, with the section
  Reason reason = Reason::unspecified;
  std::string told = {};                                 // text that the message must contain
  std::vector<Case> cases = {};                          // one or more for each command
  std::function<void(Device&, TimePoint)> strikes = {};  // makes the condition true; empty: the line itself is wrong
  std::function<void(simulation::Setup&)> set_up = {};   // configures the simulator and the gateway
  Lines device_before = {};   // lines of another program, before the power is switched off and on
  bool strikes_early = true;  // also tested with the condition long before the request
  // Reports whether the gateway must not send the line if it knows the condition before the request.
  std::function<bool(const Sentence&)> never_sent = [](const Sentence&) { return false; };
};

std::vector<Condition> conditions();

// The conditions in groups.
std::vector<Condition> states_of_axes();
std::vector<Condition> modes();
std::vector<Condition> wrong_lines();

// Returns a case, with the valid line, for each sentence that `concerned` accepts.
std::vector<Case> ordinary(const std::function<bool(const Sentence&)>& concerned);

}  // namespace axisgate::refusals
