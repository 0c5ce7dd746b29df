// How far the controller's program is (manual 41) ?:L).
#pragma once

#include <optional>
#include <string>

#include "device/shrc203/session/dialogue.h"

namespace axisgate::shrc203 {

struct ProgramStatus {
  std::string program, status, line;  // as ?:L reports them

  // It runs, or runs one line. Where it pauses it waits for somebody.
  bool runs() const { return status == "1" || status == "3"; }
};

// Nothing where the answer does not report it.
std::optional<ProgramStatus> program_status(const ExchangeResult& result);

}  // namespace axisgate::shrc203
