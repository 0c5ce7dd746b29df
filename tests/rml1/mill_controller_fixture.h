// Fixture of a mill's controller with a line, rights and listeners that a test sets.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device/rml1/mill/mill_controller.h"
#include "tests/rml1/fake_mill_line.h"
#include "tests/rml1/fake_permission.h"
#include "tests/rml1/mill.h"

namespace axisgate::rml1 {

class MillControllerTest : public testing::Test, protected jobs::MachineEvents {
 protected:
  void SetUp() override { mill_.link_up(now_); }
  void TearDown() override { EXPECT_EQ(mill_.broken_invariant(), ""); }

  // Returns moves of 10 mm at 15 mm/s, 0.7 to 0.9 s each by the profile.
  static std::string vectors(int count) {
    std::string job = "V15;VS15;";
    for (int i = 0; i < count; ++i) job += i % 2 == 0 ? "PU1000,0;" : "PU0,0;";
    return job;
  }
  static jobs::JobSetup setup(std::string digest = "d1") { return {std::move(digest), "test", "corner", "T1"}; }
  void add(jobs::JobNumber number, std::string owner = "unix anna", std::string digest = "d1") {
    jobs::Job job{.number = number, .name = "part.rml", .owner = std::move(owner), .setup = setup(std::move(digest))};
    mill_.add(std::move(job), now_);
  }
  std::shared_ptr<const PreparedJob> prepared(int count = 20, std::string digest = "d1") {
    return std::make_shared<const PreparedJob>(vectors(count), std::move(digest), profile_, std::nullopt,
                                               settings_.sending);
  }
  Result<void> confirm(jobs::JobNumber number) { return mill_.confirm(number, setup(), "unix bert", now_); }
  void run_job(jobs::JobNumber number, int count = 20) {
    ASSERT_TRUE(confirm(number));
    ASSERT_TRUE(mill_.start(number, prepared(count), {.who = "unix anna"}, now_));
  }
  void run_for(Duration time) {
    for (const TimePoint end = now_ + time; now_ < end; now_ += std::chrono::milliseconds(1)) {
      line_.run_to(now_);
      if (const auto due = mill_.next_deadline(); due && *due <= now_) mill_.advance(now_);
      ASSERT_EQ(mill_.broken_invariant(), "");
    }
  }
  jobs::JobState state(jobs::JobNumber number) const {
    for (const jobs::Job& job : mill_.jobs()) {
      if (job.number == number) return job.state;
    }
    return ended_.at(number);
  }
  std::string written() const {
    std::string all;
    for (const std::string& one : line_.writes) all += one;
    return all;
  }
  static Reason reason(const Result<void>& result) { return result ? Reason::unspecified : result.error().reason; }

  void link_changed(jobs::MachineLink, std::string_view, TimePoint) override {}
  void job_changed(const jobs::Job& job, std::string_view by, std::string_view why, TimePoint) override {
    ended_[job.number] = job.state;
    said_.push_back(std::string(name(job.state)) + (why.empty() ? "" : ": ") + std::string(why));
    by_[job.state] = by;
  }
  void rank_changed(const jobs::Job& job) override { ranks_[job.number] = job.rank; }
  void z0_sent(std::uint64_t z0_count) override { z0_count_ = z0_count; }
  void internal_error(std::string_view what, TimePoint) override { ADD_FAILURE() << what; }
  void sender_changed(const jobs::RunningJob& running, TimePoint) override {
    said_.emplace_back(name(running.sender));
    if (running.busy) said_.emplace_back("busy");
  }
  void written(std::string_view, jobs::JobNumber) override {}
  void abort_requested(std::string_view, TimePoint) override { ++aborts_requested_; }
  void about_to_write(jobs::JobNumber, const jobs::WrittenRange& sent) override {
    noted_ = sent.most;
    written_before_note_ = line_.writes.size();
  }

  const Profile profile_ = test_profile();
  FakeMillLine line_;
  TimePoint now_{std::chrono::seconds(1000)};
  jobs::MachineSettings settings_;
  std::map<jobs::JobNumber, jobs::JobState> ended_;
  std::map<jobs::JobNumber, std::int64_t> ranks_;  // ranks that were stored
  std::vector<std::string> said_;
  std::map<jobs::JobState, std::string> by_;
  std::uint64_t noted_ = 0, z0_count_ = 0;
  std::size_t written_before_note_ = 0;
  int aborts_requested_ = 0;
  FakePermission permission_;
  MillController mill_{profile_, settings_, line_, *this, permission_};
};

}  // namespace axisgate::rml1
