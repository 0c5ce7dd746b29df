// Generation of device/shrc203/REFUSALS.md from the results of the trials.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/refusals/trial.h"

namespace axisgate::refusals {

// Result of one case: the gateway's answer if the condition became true as the line arrived, and whether the line was
// sent if the gateway could know the condition before.
struct Outcome {
  const Condition* condition = nullptr;
  const Case* one = nullptr;
  Verdict told;
  bool sent = true;
};

// Returns the name of the gRPC code for each Reason's name, from the comments of common.proto.
std::map<std::string, std::string> codes_by_reason(const std::string& common_proto);

std::string refusals_page(const std::vector<Outcome>& outcomes, const std::map<std::string, std::string>& codes);

}  // namespace axisgate::refusals
