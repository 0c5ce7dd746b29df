// Opens a printer device of the kernel to which a mill is connected: bytes are only written.
#pragma once

#include <string>

#include "device/core/problem.h"

namespace axisgate {

struct PrinterSettings {
  std::string path;  // "/dev/usb/lp0"
};

// Returns a non-blocking descriptor for writing alone. The caller must close it; closing does not wait. The driver
// allows only one process to open the device. Thread safe.
// Fails with link_down and a message for people: no such device, permission denied, in use by another process, or a
// terminal or a file instead of a printer.
Result<int> open_printer(const PrinterSettings& settings);

}  // namespace axisgate
