// The thread that drives lines.
#pragma once

#include <optional>
#include <thread>

#include "device/core/time.h"
#include "device/link/asio.h"

namespace axisgate {

// Whether the thread stays awake for a moment. To be put to sleep and woken takes longer than an instant device
// needs for its reply, and a client for its next question. Such a device is a simulator: nobody stays awake for a line
// that takes time. On the thread of its lines only.
class Wakefulness {
 public:
  bool is_awake(TimePoint now) const { return now < until_; }
  void written(TimePoint now);  // a command
  void replied(TimePoint now);  // bytes came; those that no command waits for do not count

 private:
  bool device_is_prompt_ = false;  // whichever replied last
  std::optional<TimePoint> written_;
  TimePoint until_{};
};

class LineThread {
 public:
  LineThread() = default;
  ~LineThread() { stop(); }
  LineThread(const LineThread&) = delete;
  LineThread& operator=(const LineThread&) = delete;

  void start();
  // Waits for what runs. What is still posted does not run.
  void stop();

  boost::asio::io_context& context() { return context_; }
  Strand new_strand() { return Strand(context_.get_executor()); }
  Wakefulness& wakefulness() { return wakefulness_; }

 private:
  void run();

  boost::asio::io_context context_{1};
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{context_.get_executor()};
  Wakefulness wakefulness_;
  std::thread thread_;
};

}  // namespace axisgate
