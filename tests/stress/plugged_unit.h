// Simulated SHRC-203 at a pseudo terminal, on a separate thread.
#pragma once

#include <memory>
#include <string>
#include <thread>

#include "device/core/paced_line.h"
#include "device/link/asio.h"
#include "device/link/pty_line.h"
#include "device/shrc203/simulator/options.h"

namespace axisgate::stress {

// A PluggedUnit runs 100 times faster than real time, and its bytes take no time. Its destruction has the effect of a
// pulled cable: a program that has the terminal open loses it at once, and the path is removed. Another unit may then
// use the same path.
class PluggedUnit {
 public:
  PluggedUnit(const std::string& path, shrc203::simulator::Options options);
  ~PluggedUnit();
  PluggedUnit(const PluggedUnit&) = delete;
  PluggedUnit& operator=(const PluggedUnit&) = delete;

 private:
  boost::asio::io_context context_{1};
  std::shared_ptr<PtyLine> line_;
  std::unique_ptr<PacedLine> device_;
  std::thread thread_;
};

}  // namespace axisgate::stress
