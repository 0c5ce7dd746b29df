// Fixture of a sender with a line that a test sets, in steps of a millisecond.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "device/rml1/sending/sender.h"
#include "tests/rml1/fake_mill_line.h"
#include "tests/rml1/mill.h"
#include "tests/rml1/sender_line.h"

namespace axisgate::rml1 {

class SenderTest : public testing::Test {
 protected:
  // Returns moves of 10 mm at 15 mm/s, 0.7 to 0.9 s each by the profile, without a spin-up.
  static std::string vectors(int count) {
    std::string job = "!MC0;^PA;V15;VS15;";
    for (int i = 0; i < count; ++i) job += i % 2 == 0 ? "PU1000,0;" : "PU0,0;";
    return job;
  }
  void begin(const std::string& job, jobs::SendSettings settings = {}) {
    job_ = job;
    timeline_.emplace(job_, profile_, std::nullopt);
    sender_.emplace(job_, *timeline_, profile_, settings, plan_of(job_, *timeline_, settings), beside_.mill());
    sender_->start(now_);
  }
  void run_for(Duration time) {
    for (const TimePoint end = now_ + time; now_ < end; now_ += std::chrono::milliseconds(1)) {
      line_.run_to(now_);
      sender_->advance(now_);
    }
  }
  void TearDown() override { EXPECT_EQ(beside_.reported.all, std::vector<std::string>()); }
  jobs::SendProgress progress() { return sender_->progress(now_); }
  std::string written() const {
    std::string all;
    for (const std::string& one : line_.writes) all += one;
    return all;
  }

  const Profile profile_ = test_profile();
  FakeMillLine line_;
  SenderLine beside_{profile_, {}, line_};
  TimePoint now_{std::chrono::seconds(1000)};
  std::string job_;
  std::optional<Timeline> timeline_;
  std::optional<Sender> sender_;
};

}  // namespace axisgate::rml1
