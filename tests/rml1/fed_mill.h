// Test bench of a sender and a simulated mill at the two ends of a line, in virtual time. It shows which bytes the mill
// has executed, and when.
#pragma once

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "device/rml1/sending/sender.h"
#include "device/rml1/simulator/simulator.h"

namespace axisgate::rml1 {

// A FedMill sends bytes one after the other while the mill does not stop its host.
class FedMill : public FlowLink {
 public:
  // The job must outlive this object.
  FedMill(std::string_view job, simulator::MillSetup setup, int baud)
      : job_(job),
        byte_time_(std::chrono::nanoseconds(std::chrono::seconds(10)) / baud),
        mill_(std::move(setup), nobody_, [this](std::string_view line) { recorded(line); }) {}

  // Runs host and mill until `now`, which must ascend.
  void run_to(TimePoint now) {
    while (!queue_.empty() && wait_until_released(now) && last_ + byte_time_ <= now) {
      last_ += byte_time_;
      const char byte = queue_.front();
      queue_.erase(0, 1);
      mill_.advance(last_);  // commands that begin before this byte arrives
      ++received_;
      mill_.receive({&byte, 1}, last_);
    }
    if (queue_.empty() || held()) last_ = now;
    mill_.advance(now);
  }

  void write(std::string_view bytes) override { queue_ += bytes; }
  void reopen(Duration) override {}
  std::size_t unsent() const override { return queue_.size(); }
  bool held() const override { return mill_.holds_back(); }
  void ignore_flow_control(bool) override {}

  // Returns the number of executed bytes of the job, including the delimiters after them.
  std::uint64_t executed() const {
    std::uint64_t end = mill_.next_deadline() ? before_ : begun_;
    while (end < job_.size() && (job_[end] == ';' || job_[end] <= ' ')) ++end;
    return end;
  }
  // Returns the end of the mill's last movement, in seconds since it was switched on.
  double seconds() const { return seconds_; }
  simulator::Simulator& mill() { return mill_; }

 private:
  class Nobody : public ByteLink {
    void write(std::string_view) override {}
    void reopen(Duration) override {}
  };

  bool wait_until_released(TimePoint now) {
    while (mill_.holds_back()) {
      const auto next = mill_.next_deadline();
      if (!next || *next > now) return false;
      mill_.advance(*next);
      last_ = *next;
    }
    return true;
  }

  // Handles {"t":3,"command":"PD","numbers":[10,20],"buffered":6} and {"t":4,"began":3,"path":...}.
  void recorded(std::string_view line) {
    if (line.find("\"command\":") != std::string_view::npos) {
      const auto begun = received_ - static_cast<std::uint64_t>(number_after(line, "\"buffered\":"));
      if (begun > begun_) before_ = std::exchange(begun_, begun);
    } else if (line.find("\"path\":") != std::string_view::npos) {
      seconds_ = number_after(line, "\"t\":");
    }
  }

  static double number_after(std::string_view line, std::string_view key) {
    double number = 0;
    const auto text = line.substr(line.find(key) + key.size());
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
  }

  const std::string_view job_;
  const Duration byte_time_;
  Nobody nobody_;
  TimePoint last_{};  // when the last byte left, or could have left
  std::string queue_;
  std::uint64_t received_ = 0, before_ = 0,
                begun_ = 0;  // bytes; `before_` and `begun_` are the ends of the last two commands that began
  double seconds_ = 0;
  simulator::Simulator mill_;
};

// Sends the whole job, with each call at the time that the sender names. Calls `look` with the time once in every
// `period`.
template <class Line, class Look>
void feed_all(Sender& sender, Line& line, Duration period, Look&& look) {
  TimePoint now{}, next_look = now + period;
  sender.start(now);
  while (!is_end(sender.state())) {
    const auto due = sender.next_deadline(now);
    now = std::max(now, due ? std::min(*due, next_look) : next_look);
    line.run_to(now);
    sender.advance(now);
    if (now < next_look) continue;
    look(now);
    next_look += period;
  }
}

}  // namespace axisgate::rml1
