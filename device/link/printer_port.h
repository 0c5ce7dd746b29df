// Opens a printer device of the kernel, behind which a mill is: bytes go one way.
#pragma once

#include <string>

#include "device/core/problem.h"

namespace axisgate {

struct PrinterSettings {
  std::string path;  // "/dev/usb/lp0"
};

// A non-blocking descriptor for writing alone; the caller closes it, which waits for nothing. The driver lets one
// process have it open. Every failure is link_down, with a message for people: no such device, not permitted, held by
// another process, a terminal or a file instead of a printer. Thread safe.
Result<int> open_printer(const PrinterSettings& settings);

}  // namespace axisgate
