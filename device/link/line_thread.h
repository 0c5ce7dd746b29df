// Thread that drives lines.
#pragma once

#include <optional>
#include <thread>

#include "device/core/time.h"
#include "device/link/asio.h"

namespace axisgate {

// Decides when the thread stays awake for a moment. Sleeping and waking takes longer than an instant device needs for
// its reply, and longer than a client needs for its next question. Only a simulator is that fast; for a slower line the
// thread sleeps. Use it only on the thread of its lines.
class Wakefulness {
 public:
  bool is_awake(TimePoint now) const { return now < until_; }
  void written(TimePoint now);  // a command was written
  void replied(TimePoint now);  // bytes came; bytes that no command waits for do not count

 private:
  bool device_is_prompt_ = false;  // the device that replied last is prompt
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
  // Waits for the running task. Other posted tasks do not run.
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
