// Opens a serial port as the configuration says, for this process alone.
#pragma once

#include <string>

#include "device/core/problem.h"

namespace axisgate {

enum class Parity { none, even, odd };
// The driver does the first three. Linux has nothing for DTR/DSR: the port is opened without flow control, with DTR
// raised for the device to read, and who writes asks is_held() before.
enum class FlowControl { none, rts_cts, xon_xoff, dtr_dsr };

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

// Whether the device forbids sending by its modem line. `modem_lines`: of TIOCMGET. The device's RTS arrives as CTS,
// its DTR as DSR. Thread safe.
bool forbids(FlowControl flow, int modem_lines);
// As the port's lines are now. False for a port without modem lines, as a pseudo-terminal. Does not block.
bool is_held(int port, FlowControl flow);

}  // namespace axisgate
