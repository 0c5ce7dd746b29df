// Collector of the events that state machines report as illegal.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "device/core/violations.h"

namespace axisgate {

class Reported : public Violations {
 public:
  void illegal(std::string_view machine, std::string_view state, std::string_view event) override {
    all.push_back(std::string(machine) + " " + std::string(state) + " " + std::string(event));
  }
  std::vector<std::string> all;
};

}  // namespace axisgate
