// A device on a line with a transfer time.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "device/core/paced_line.h"
#include "device/shrc203/simulator/simulator.h"

namespace axisgate::shrc203::simulator::simulator_paced_line_test {
namespace {

using namespace std::chrono_literals;

TimePoint at(Duration time) { return TimePoint{} + 24h + time; }

class Host : public ByteLink {
 public:
  explicit Host(Pacing pacing)
      : line(pacing, *this, [this](ByteLink& inside) -> std::unique_ptr<LineMachine> {
          auto device = std::make_unique<Simulator>(Options(), inside);
          simulator = device.get();
          return device;
        }) {
    line.link_up(at(0s));
  }

  void write(std::string_view bytes) override {
    for (const char byte : bytes) heard.emplace_back(byte, now_);
  }
  void reopen(Duration) override { ++reopened; }

  void run_to(Duration time) {
    for (auto next = line.next_deadline(); next && *next <= at(time); next = line.next_deadline()) {
      now_ = *next;
      line.advance(*next);
    }
    now_ = at(time);
    line.advance(now_);
  }

  std::string text() const {
    std::string all;
    for (const auto& [byte, time] : heard) all += byte;
    return all;
  }

  std::vector<std::pair<char, TimePoint>> heard;
  int reopened = 0;
  Simulator* simulator = nullptr;
  PacedLine line;

 private:
  TimePoint now_ = at(0s);
};

TEST(PacedLine, WithoutPacingEverythingIsAtOnce) {
  Host host({});
  host.line.receive("!:\r\n", at(1s));
  EXPECT_EQ(host.text(), "R\r\n");
  EXPECT_EQ(host.line.next_deadline(), std::nullopt);
  EXPECT_EQ(Pacing().speed, 1) << "its time is the shell's";
}

// Ten bits a byte: at 10000 baud a byte takes a millisecond.
TEST(PacedLine, BytesTakeTheirTimeBothWays) {
  Host host({10000, 0ms, 1});
  host.line.receive("!:\r\n", at(0s));
  host.run_to(1s);
  ASSERT_EQ(host.text(), "R\r\n");
  EXPECT_EQ(host.heard[0].second, at(4ms));  // the reply begins after CR, the third byte
  EXPECT_EQ(host.heard[1].second, at(5ms));
  EXPECT_EQ(host.heard[2].second, at(6ms));
}

TEST(PacedLine, RepliesComeLate) {
  Host host({0, 20ms, 1});
  host.line.receive("!:\r\n?:W\r\n", at(0s));
  host.run_to(19ms);
  EXPECT_EQ(host.text(), "");
  host.run_to(20ms);
  EXPECT_EQ(host.text(), "R\r\n0\r\n");
}

TEST(PacedLine, TheDevicesTimeRunsFaster) {
  Host host({0, 0ms, 10});
  host.line.receive("MP:1+P1000,S1000F1000R1\r\nG:1\r\n", at(500ms));
  host.run_to(549ms);
  EXPECT_EQ(host.simulator->position(1), 490);
  host.run_to(599ms);
  EXPECT_EQ(host.text(), "OK\r\nOK\r\n");
  host.run_to(601ms);
  EXPECT_EQ(host.text(), "OK\r\nOK\r\n1\r\n");
  EXPECT_EQ(host.heard.back().second, at(600ms));
  EXPECT_EQ(host.simulator->position(1), 1000);
}

TEST(PacedLine, OddSpeedsLoseNoDeadline) {
  Host host({9600, 3ms, 7.3});
  host.line.receive("MP:1+P1000,S1000F1000R1\r\nG:1\r\n", at(0s));
  host.run_to(10s);
  EXPECT_EQ(host.text(), "OK\r\nOK\r\n1\r\n");
  EXPECT_EQ(host.line.next_deadline(), std::nullopt);
}

TEST(PacedLine, WhatWasWrittenBeforeTheLineClosedStillArrives) {
  Host host({9600, 0ms, 1});
  host.line.receive("M:1+P1000\r\nG:1\r\n", at(0s));
  host.line.link_down(at(1ms), "closed");
  host.line.link_up(at(2ms));
  host.run_to(1s);
  EXPECT_EQ(host.text(), "");  // the answers belonged to the closed line
  EXPECT_EQ(host.simulator->position(1), 1000);
}

// An action that does not come over the line runs at the device's own time, and later answers go over the line.
TEST(PacedLine, TheDeviceIsTouchedInItsOwnTime) {
  Host host({10000, 0ms, 10});
  host.run_to(0s);
  TimePoint told{};
  host.line.touch(at(1s), [&](TimePoint device_now) {
    told = device_now;
    host.simulator->be_stuck(5s, device_now);
  });
  EXPECT_EQ(told, at(10s));
  host.line.receive("!:\r\n", at(1s));
  host.run_to(1499ms);
  EXPECT_EQ(host.text(), "");
  host.line.touch(at(1499ms), [&](TimePoint device_now) {
    host.simulator->be_stuck(0s, device_now);
    host.simulator->advance(device_now);
  });
  host.run_to(1502ms);
  EXPECT_EQ(host.text(), "R\r\n");
  EXPECT_EQ(host.heard[0].second, at(1500ms)) << "a byte takes a millisecond";
}

}  // namespace
}  // namespace axisgate::shrc203::simulator::simulator_paced_line_test
