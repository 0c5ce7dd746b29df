// Receives reports of events that the table of a state machine does not have.
#pragma once

#include <string_view>

namespace axisgate {

class Violations {
 public:
  virtual ~Violations() = default;
  // Reports an internal error of the gateway. The names are constants: "jog", "running", "begun".
  virtual void illegal(std::string_view machine, std::string_view state, std::string_view event) = 0;
};

}  // namespace axisgate
