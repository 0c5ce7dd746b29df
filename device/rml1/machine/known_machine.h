#pragma once

#include <string>

namespace axisgate::rml1 {

// A machine that the job may have been made for instead.
struct KnownMachine {
  std::string name;
  double step_mm = 0, z_mm = 0;
  double fastest = 0;  // mm/s, highest speed of F VS V !VZ; 0 if unknown
};

}  // namespace axisgate::rml1
