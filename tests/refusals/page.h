// device/shrc203/REFUSALS.md, made from what the trials reported.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tests/refusals/trial.h"

namespace axisgate::refusals {

// What became of one case: the gateway's words where the condition struck as the line arrived, and, where it has looked
// before, whether anything was sent.
struct Outcome {
  const Condition* condition = nullptr;
  const Case* one = nullptr;
  Verdict told;
  bool sent = true;
};

// By the comments of common.proto, from the Reason's name to that of its gRPC code.
std::map<std::string, std::string> codes_by_reason(const std::string& common_proto);

std::string refusals_page(const std::vector<Outcome>& outcomes, const std::map<std::string, std::string>& codes);

}  // namespace axisgate::refusals
