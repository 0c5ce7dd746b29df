// Line of a device's Runner: a serial port, a printer device, a serial server, or the built-in simulator at the other
// end of a socket pair.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "device/core/problem.h"
#include "device/link/runner.h"
#include "server/config/config.h"

namespace axisgate::server {

// A Line is used by one Device, which must not outlive the line or the strand's io_context.
class Line {
 public:
  virtual ~Line() = default;

  virtual Opener opener() = 0;
  virtual HeldReader held_reader() const { return {}; }
  virtual const std::string& description() const = 0;  // for the log: "/dev/ttyUSB0 at 38400 baud"

  virtual void start() = 0;
  virtual void shutdown() = 0;

  // Performs an action of a person at a simulated device and reports the result
  // (Simulation::operate()). `done` is called on the simulator's strand, or at once with invalid_request if
  // the device is not simulated. After shutdown() the action is dropped. May be called from any thread.
  using OnOperated = std::function<void(const Result<std::string>& answer)>;
  virtual void operate(std::string command, OnOperated done);
};

// `strand` is the simulator's.
std::unique_ptr<Line> make_line(const DeviceConfig& config, Strand strand);

}  // namespace axisgate::server
