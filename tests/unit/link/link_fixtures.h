// Fixtures for the tests of device/link: an event loop with a time limit, a machine that records, a temporary
// directory.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "device/link/asio.h"
#include "device/link/clock.h"

namespace axisgate::link_test {

// Time limit for waits, far longer than any needs; only a failing test reaches it.
inline constexpr std::chrono::seconds kPatience{10};

class EventLoop {
 public:
  Strand strand() { return boost::asio::make_strand(context_); }

  // Runs handlers until `done` returns true; returns false after kPatience.
  [[nodiscard]] bool run_until(const std::function<bool()>& done) {
    const TimePoint limit = monotonic_now() + kPatience;
    while (!done()) {
      if (monotonic_now() > limit) return false;
      context_.restart();
      context_.run_one_for(std::chrono::milliseconds(1));
    }
    return true;
  }

  // Runs the handlers that are ready now.
  void run_ready() {
    context_.restart();
    context_.poll();
  }

 private:
  boost::asio::io_context context_{1};
};

// Records what it receives, and writes each byte back if `echo` is true.
class RecordingMachine : public LineMachine {
 public:
  explicit RecordingMachine(ByteLink& link) : link_(link) {}

  void link_up(TimePoint now) override {
    const Inside inside(*this);
    heard.push_back("up");
    if (on_up) on_up(now);
  }
  void link_down(TimePoint now, std::string_view why) override {
    const Inside inside(*this);
    heard.push_back("down");
    reason = why;
    if (on_down) on_down(now);
  }
  void receive(std::string_view bytes, TimePoint) override {
    const Inside inside(*this);
    heard.push_back(std::string(bytes));
    received += bytes;
    if (echo) link_.write(bytes);
  }
  void advance(TimePoint now) override {
    const Inside inside(*this);
    advanced.push_back(now);
    if (deadline && *deadline <= now) deadline.reset();
  }
  std::optional<TimePoint> next_deadline() const override { return deadline; }

  ByteLink& link() { return link_; }
  std::size_t count(std::string_view what) const {
    return static_cast<std::size_t>(std::count(heard.begin(), heard.end(), what));
  }

  bool echo = true;
  std::optional<TimePoint> deadline;
  std::function<void(TimePoint)> on_up, on_down;
  std::vector<std::string> heard;
  std::string received, reason;
  std::vector<TimePoint> advanced;

 private:
  // Fails the test if a shell calls the machine from within one of the machine's own calls.
  class Inside {
   public:
    explicit Inside(RecordingMachine& machine) : machine_(machine) {
      EXPECT_FALSE(machine_.inside_);
      machine_.inside_ = true;
    }
    ~Inside() { machine_.inside_ = false; }

   private:
    RecordingMachine& machine_;
  };

  ByteLink& link_;
  bool inside_ = false;
};

// Returns the bytes that can be read from a non-blocking descriptor now.
inline std::string read_now(int descriptor) {
  std::string bytes;
  std::array<char, 4096> buffer;
  for (ssize_t size = 0; (size = ::read(descriptor, buffer.data(), buffer.size())) > 0;) {
    bytes.append(buffer.data(), static_cast<std::size_t>(size));
  }
  return bytes;
}

inline void send_now(int descriptor, std::string_view bytes) {
  ASSERT_EQ(::write(descriptor, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
}

class TemporaryDirectory {
 public:
  TemporaryDirectory() {
    std::string name = std::filesystem::temp_directory_path() / "axisgate-link-XXXXXX";
    EXPECT_NE(::mkdtemp(name.data()), nullptr);
    path_ = name;
  }
  ~TemporaryDirectory() { std::filesystem::remove_all(path_); }
  std::string operator/(std::string_view name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace axisgate::link_test
