// Opens a serial port as the configuration says, for this process alone.
#pragma once

#include <string>

#include "device/core/problem.h"

namespace axisgate {

enum class Parity { none, even, odd };
enum class FlowControl { none, rts_cts, xon_xoff };

// Always eight data bits.
struct SerialSettings {
  std::string path;  // "/dev/ttyUSB0"
  int baud = 38400;  // any rate that the driver takes, 1 and up
  Parity parity = Parity::none;
  int stop_bits = 1;  // 1 or 2
  FlowControl flow = FlowControl::rts_cts;
};

// A non-blocking descriptor in raw mode, locked against others by TIOCEXCL and flock, its input empty; the caller
// closes it. Every failure is link_down, with a message for people: no such device, not permitted, not a serial port,
// held by another process (which one, where that can be seen), a setting that the driver refuses.
// Thread safe. Does not wait for a modem line or for a lock.
Result<int> open_serial(const SerialSettings& settings);

}  // namespace axisgate
