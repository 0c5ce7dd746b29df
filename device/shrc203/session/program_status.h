// Status of the controller's program (manual 41) ?:L).
#pragma once

#include <optional>
#include <string>

#include "device/shrc203/session/dialogue.h"

namespace axisgate::shrc203 {

struct ProgramStatus {
  std::string program, status, line;  // as ?:L reports them

  // Reports whether the program runs, or runs one line. A paused program waits for a person.
  bool runs() const { return status == "1" || status == "3"; }
};

// Returns nullopt if the reply is not a program status.
std::optional<ProgramStatus> program_status(const ExchangeResult& result);

}  // namespace axisgate::shrc203
