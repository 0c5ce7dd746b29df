// The conditions under which the manual lets the controller answer NG, and what the gateway is to say of each.
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

// One command under one condition.
struct Case {
  const Sentence* sentence = nullptr;
  std::string line;        // the one that is refused
  Lines whole;             // the transaction that it stands in
  Lines simulator_before;  // what is sent to the simulator before, each accepted
  Reason reason = Reason::unspecified;
};

struct Condition {
  std::string name;    // a heading
  std::string manual;  // what says so, with the section
  Reason reason = Reason::unspecified;
  std::string told = {};                                 // what the message holds
  std::vector<Case> cases = {};                          // by command
  std::function<void(Device&, TimePoint)> strikes = {};  // nothing: the line itself is what is refused
  std::function<void(simulation::Setup&)> set_up = {};   // of the simulator and the gateway
  Lines device_before = {};   // lines of somebody else's, before the power is switched off and on
  bool strikes_early = true;  // also tried long before the request
  // Of what is known before, none is sent.
  std::function<bool(const Sentence&)> never_sent = [](const Sentence&) { return false; };
};

std::vector<Condition> conditions();

// By what they have in common.
std::vector<Condition> states_of_axes();
std::vector<Condition> modes();
std::vector<Condition> wrong_lines();

// A case for each sentence that it concerns, in its ordinary form.
std::vector<Case> ordinary(const std::function<bool(const Sentence&)>& concerned);

}  // namespace axisgate::refusals
