// Line to a mill in virtual time: a host's queue that empties at the line's speed, and flow control that a test sets.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "device/core/time.h"

namespace axisgate::rml1 {

class FakeMillLine : public FlowLink {
 public:
  explicit FakeMillLine(int baud = 9600) : byte_time_(std::chrono::nanoseconds(std::chrono::seconds(10)) / baud) {}

  // Sends the bytes that leave the host until `now`, which must ascend.
  void run_to(TimePoint now) {
    for (; !queue_.empty() && may_leave() && last_ + byte_time_ <= now; queue_.erase(0, 1)) {
      last_ += byte_time_;
      received += queue_[0];
    }
    if (queue_.empty() || !may_leave()) last_ = now;
  }

  void write(std::string_view bytes) override {
    writes.emplace_back(bytes);
    queue_ += bytes;
  }
  void reopen(Duration) override { ++reopened; }
  std::size_t unsent() const override { return queue_.size(); }
  bool held() const override { return busy; }
  void ignore_flow_control(bool ignored) override { ignores = ignored; }

  std::size_t room = 4096;  // bytes that one write accepts
  bool busy = false, ignores = false;
  std::string received;             // bytes received by the mill
  std::vector<std::string> writes;  // one string for each write
  int reopened = 0;

 private:
  bool may_leave() const { return !busy || ignores; }

  Duration byte_time_;
  TimePoint last_{};
  std::string queue_;
};

}  // namespace axisgate::rml1
