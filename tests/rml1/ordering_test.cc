// Tests of the order of a mill's queue: who may move a job before which others, and that the order survives a restart.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "tests/rml1/mill_controller_fixture.h"

namespace axisgate::rml1 {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using enum jobs::JobState;
using Numbers = std::vector<jobs::JobNumber>;

class MillQueueOrder : public MillControllerTest {
 protected:
  static Numbers order_of(const MillController& mill) {
    Numbers numbers;
    for (const jobs::Job& job : mill.jobs()) numbers.push_back(job.number);
    return numbers;
  }
  Numbers order() const { return order_of(mill_); }
  Result<void> first(jobs::JobNumber number, jobs::Overtaken overtaken = jobs::Overtaken::all) {
    return mill_.move_first(number, overtaken, "unix root", now_);
  }
  // Returns the order in the next run of the daemon, from the stored facts of each job. These include neither its place
  // nor its confirmation.
  Numbers order_after_restart(std::uint64_t seed = 0) {
    std::vector<jobs::Job> jobs = mill_.jobs();
    std::shuffle(jobs.begin(), jobs.end(), std::mt19937_64(seed));
    MillController after(profile_, settings_, line_, *this, permission_);
    for (jobs::Job job : jobs) {
      job.rank = ranks_.contains(job.number) ? ranks_.at(job.number) : 0;
      if (job.state == confirmed) job.state = job.part == 0 ? queued : tool_change;
      after.inherit(std::move(job));
    }
    return order_of(after);
  }
};

TEST_F(MillQueueOrder, AnAdministratorMovesAJobBeforeAllThatAreQueued) {
  for (const jobs::JobNumber number : {1, 2, 3, 4}) add(number, number % 2 == 0 ? "unix anna" : "unix bert");
  ASSERT_TRUE(first(3));
  EXPECT_THAT(order(), ElementsAre(3, 1, 2, 4));
  EXPECT_EQ(said_.back(), "QUEUED: moved to the front of the queue");
  EXPECT_EQ(by_[queued], "unix root");
  ASSERT_TRUE(first(4));
  EXPECT_THAT(order(), ElementsAre(4, 3, 1, 2));
  EXPECT_THAT(order_after_restart(), ElementsAre(4, 3, 1, 2));
  EXPECT_TRUE(confirm(4)) << "it is the next one";
}

TEST_F(MillQueueOrder, TheJobsOfOthersKeepTheirPlaces) {
  for (const jobs::JobNumber number : {1, 2, 3, 4, 5})
    add(number, number == 1 || number == 3 ? "unix bert" : "unix anna");
  ASSERT_TRUE(first(5, jobs::Overtaken::of_its_owner));
  EXPECT_THAT(order(), ElementsAre(1, 5, 3, 2, 4));
  EXPECT_EQ(said_.back(), "QUEUED: moved before the other jobs of its owner");
  EXPECT_THAT(order_after_restart(), ElementsAre(1, 5, 3, 2, 4));
}

TEST_F(MillQueueOrder, WhereItIsTheFirstNothingHappens) {
  add(1, "unix bert");
  add(2);
  said_.clear();
  EXPECT_TRUE(first(1));
  EXPECT_TRUE(first(2, jobs::Overtaken::of_its_owner));
  EXPECT_THAT(order(), ElementsAre(1, 2));
  EXPECT_THAT(said_, IsEmpty());
  EXPECT_THAT(ranks_, IsEmpty());
}

TEST_F(MillQueueOrder, AConfirmedJobIsNeitherMovedNorOvertaken) {
  for (const jobs::JobNumber number : {1, 2, 3}) add(number);
  ASSERT_TRUE(confirm(1));
  ASSERT_TRUE(first(3));
  EXPECT_THAT(order(), ElementsAre(1, 3, 2));
  EXPECT_EQ(state(1), confirmed);
  EXPECT_EQ(reason(first(1)), Reason::wrong_job_state);
  EXPECT_THAT(order_after_restart(), ElementsAre(1, 3, 2)) << "also without its confirmation";
  mill_.setup_changed("by hand", now_);
  ASSERT_TRUE(first(2));
  EXPECT_THAT(order(), ElementsAre(2, 1, 3)) << "a void confirmation holds nobody back";
}

TEST_F(MillQueueOrder, WhatWasBegunIsNeitherMovedNorOvertaken) {
  add(1);
  add(2);
  add(3);
  run_job(1, 200);
  ASSERT_TRUE(first(3));
  EXPECT_THAT(order(), ElementsAre(1, 3, 2));
  const Result<void> running_one = first(1);
  EXPECT_EQ(reason(running_one), Reason::wrong_job_state);
  EXPECT_THAT(running_one.error().message, HasSubstr("job 1 (part.rml, by unix anna) is RUNNING"));
  mill_.link_down(now_, "unplugged");
  ASSERT_EQ(state(1), paused_unknown);
  ASSERT_TRUE(first(2));
  EXPECT_THAT(order(), ElementsAre(1, 2, 3));
  EXPECT_EQ(reason(first(1)), Reason::wrong_job_state);
  EXPECT_EQ(reason(first(9)), Reason::not_found);
  EXPECT_THAT(order_after_restart(), ElementsAre(1, 2, 3));
}

// The next run knows the job's rank only if the daemon was not killed before it was stored.
TEST_F(MillQueueOrder, WhatWasBegunIsBeforeTheOthersWhateverItsRank) {
  for (const jobs::JobState begun : {tool_change, fed, paused_unknown}) {
    MillController after(profile_, settings_, line_, *this, permission_);
    after.inherit({.number = 1, .name = "part.rml", .owner = "unix anna", .rank = -7});
    after.inherit({.number = 3, .name = "part.rml", .owner = "unix anna", .state = begun});
    after.inherit({.number = 2, .name = "part.rml", .owner = "unix anna"});
    EXPECT_THAT(order_of(after), ElementsAre(3, 1, 2)) << name(begun);
  }
}

TEST_F(MillQueueOrder, WhatIsLeftIsShownToWhoConfirmsTheNewFirst) {
  mill_.inherit_left({.number = 7, .name = "lid.rml", .leaves = {.surface = true}});
  add(8);
  add(9);
  ASSERT_TRUE(first(9));
  ASSERT_THAT(order(), ElementsAre(9, 8));
  EXPECT_THAT(mill_.jobs()[0].setup.left, ElementsAre("job 7 (lid.rml) sets Z0"));
  EXPECT_THAT(mill_.jobs()[1].setup.left, IsEmpty());
  EXPECT_EQ(reason(confirm(9)), Reason::setup_changed) << "nothing was seen";
}

TEST_F(MillQueueOrder, WhatIsSentLaterIsBehindAllThatWereMoved) {
  for (const jobs::JobNumber number : {1, 2, 3}) add(number);
  for (const jobs::JobNumber number : {2, 3, 1, 3}) ASSERT_TRUE(first(number));
  add(4);
  EXPECT_THAT(order(), ElementsAre(3, 1, 2, 4));
  EXPECT_THAT(order_after_restart(), ElementsAre(3, 1, 2, 4));
}

TEST_F(MillQueueOrder, AJobThatNobodyConfirmsEnds) {
  add(1);
  now_ += 24h;
  add(2);
  const TimePoint due = now_ + 13 * 24h;
  EXPECT_EQ(mill_.next_deadline(), due);
  now_ = due - 1ns;
  mill_.advance(now_);
  EXPECT_EQ(state(1), queued);
  now_ = due;
  mill_.advance(now_);
  EXPECT_EQ(state(1), expired);
  EXPECT_EQ(said_.back(), "EXPIRED: nobody confirmed it within 14 days");
  EXPECT_EQ(by_[expired], "");
  EXPECT_EQ(order(), Numbers{2}) << "sent a day later";
  EXPECT_EQ(mill_.next_deadline(), due + 24h);
}

TEST_F(MillQueueOrder, AConfirmedJobDoesNotExpireAndAVoidConfirmationCountsAnew) {
  add(1);
  now_ += 14 * 24h - 1min;
  ASSERT_TRUE(confirm(1));
  now_ += 5min;
  mill_.advance(now_);
  EXPECT_EQ(state(1), confirmed);
  mill_.setup_changed("the line was lost", now_);
  mill_.advance(now_);
  EXPECT_EQ(state(1), queued);
  now_ += 14 * 24h;
  mill_.advance(now_);
  EXPECT_EQ(state(1), expired);
}

// The job's workpiece may be in the mill.
TEST_F(MillQueueOrder, AJobThatWasBegunDoesNotExpire) {
  add(1);
  run_job(1, 200);
  add(2);
  mill_.link_down(now_, "unplugged");
  now_ += 15 * 24h;
  mill_.advance(now_);
  EXPECT_EQ(state(1), paused_unknown);
  EXPECT_EQ(state(2), expired);
}

TEST_F(MillQueueOrder, AJobOfARunBeforeExpiresByTheTimeItWasSent) {
  MillController after(profile_, settings_, line_, *this, permission_);
  after.inherit({.number = 1, .queued_since = now_ - 14 * 24h});
  after.inherit({.number = 2, .queued_since = now_ - 13 * 24h});
  after.advance(now_);
  EXPECT_EQ(state(1), expired);
  ASSERT_EQ(after.jobs().size(), 1u);
  EXPECT_EQ(after.jobs().front().number, 2u);
}

// Draws who moves, sends, confirms and cancels jobs. After each act: if a job was moved for its owner, all others have
// kept their places; a confirmed job is first; and a restart has the same order from the stored ranks.
class RandomMillQueue : public MillQueueOrder {
 protected:
  void run(std::uint64_t seed) {
    SCOPED_TRACE(fmt::format("replay with AXISGATE_SEED={}", seed));
    random_.seed(seed);
    jobs::JobNumber last = 0;
    for (int step = 0; step < 40 && !HasFailure(); ++step) {
      const std::vector<jobs::Job>& jobs = mill_.jobs();
      const jobs::JobNumber any = jobs.empty() ? 0 : jobs[draw(jobs.size())].number;
      const std::size_t act = draw(8);
      if (act < 3 || jobs.size() < 3) {
        add(++last, draw(2) == 0 ? "unix anna" : "unix bert");
      } else if (act < 6) {
        move(any);
      } else if (act == 6) {
        (void)confirm(jobs.front().number);
      } else {
        (void)mill_.cancel(any, "unix root", now_);
      }
      EXPECT_EQ(order_after_restart(seed), order());
    }
    while (!mill_.jobs().empty()) (void)mill_.cancel(mill_.jobs().front().number, "unix root", now_);
    ranks_.clear();
  }

 private:
  std::size_t draw(std::size_t below) { return std::uniform_int_distribution<std::size_t>(0, below - 1)(random_); }
  void move(jobs::JobNumber number) {
    const std::vector<jobs::Job> before = mill_.jobs();
    const jobs::Job& moved = *std::ranges::find(before, number, &jobs::Job::number);
    const bool all = draw(2) == 0;
    const Result<void> done = first(number, all ? jobs::Overtaken::all : jobs::Overtaken::of_its_owner);
    ASSERT_EQ(done.has_value(), moved.state == queued);
    const auto takes_part = [&](const jobs::Job& job) {
      return job.state == queued && (all || job.owner == moved.owner);
    };
    Numbers those{number}, expected;
    for (const jobs::Job& job : before) {
      if (takes_part(job) && job.number != number) those.push_back(job.number);
    }
    auto next = those.begin();
    for (const jobs::Job& job : before) expected.push_back(done && takes_part(job) ? *next++ : job.number);
    EXPECT_EQ(order(), expected) << "job " << number << (all ? " before all" : " before those of its owner");
  }

  std::mt19937_64 random_;
};

TEST_F(RandomMillQueue, OnlyThosePassWhoMay) {
  if (const char* only = std::getenv("AXISGATE_SEED")) return run(std::strtoull(only, nullptr, 10));
  for (std::uint64_t seed = 0; seed < 300 && !HasFailure(); ++seed) run(seed);
}

}  // namespace
}  // namespace axisgate::rml1
