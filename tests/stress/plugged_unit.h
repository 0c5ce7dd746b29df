// A simulated SHRC-203 behind a pseudo terminal, on a thread of its own.
#pragma once

#include <memory>
#include <string>
#include <thread>

#include "device/core/paced_line.h"
#include "device/link/asio.h"
#include "device/link/pty_line.h"
#include "device/shrc203/simulator/options.h"

namespace axisgate::stress {

// Its time runs 100 times as fast as ours, its bytes take none. It ends as when its cable is pulled: a program that has
// the terminal open loses it at once, and the path is gone. Another unit may then take the same path.
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
