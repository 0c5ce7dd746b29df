// Where a state machine reports an event that its table does not have.
#pragma once

#include <string_view>

namespace axisgate {

class Violations {
 public:
  virtual ~Violations() = default;
  // An error of the gateway's own. The names are constants: "jog", "running", "begun".
  virtual void illegal(std::string_view machine, std::string_view state, std::string_view event) = 0;
};

}  // namespace axisgate
