// Opens a serial port with the configured settings, for this process alone.
#pragma once

#include <string>

#include "device/core/problem.h"

namespace axisgate {

enum class Parity { none, even, odd };
// The driver implements the first three. Linux has no DTR/DSR flow control: the port is opened without flow control,
// with DTR raised for the device to read, and the sender must check is_held() first.
enum class FlowControl { none, rts_cts, xon_xoff, dtr_dsr };

// Settings of a serial port; always eight data bits.
struct SerialSettings {
  std::string path;  // "/dev/ttyUSB0"
  int baud = 38400;  // any rate that the driver accepts, 1 and up
  Parity parity = Parity::none;
  int stop_bits = 1;  // 1 or 2
  FlowControl flow = FlowControl::rts_cts;
};

// Returns a non-blocking descriptor in raw mode with an empty input, locked against others by TIOCEXCL and flock. The
// caller must close it. Thread safe. Does not wait for a modem line or for a lock.
// Fails with link_down and a message for people: no such device, permission denied, not a serial port, in use by
// another process (with its id if it is visible), or a setting that the driver refuses.
Result<int> open_serial(const SerialSettings& settings);

// Reports whether the device forbids sending by its modem line. `modem_lines`: from TIOCMGET. The device's RTS arrives
// as CTS, its DTR as DSR. Thread safe.
bool forbids(FlowControl flow, int modem_lines);
// Reports whether the port's lines forbid sending now. False for a port without modem lines, such as a pseudo-terminal.
// Does not block.
bool is_held(int port, FlowControl flow);

}  // namespace axisgate
