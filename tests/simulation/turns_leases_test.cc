// Tests of a caller who moves without a lease and without a pause: callers with questions, and callers who wait for a
// lease, get their turns.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/access/leases.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using server::Lease;
using server::LeaseToken;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::int64_t kWay = 20'000, kWayUnderLease = 10'000;  // take 1 s and 0.5 s
constexpr std::array<const char*, 4> kRareQuestions = {"?:AXIS", "?:BEEP", "I:", "Q:"};
constexpr int kAskers = 16;  // for each question
constexpr Duration kLongest = seconds(5);

class TurnsAmidMotions : public testing::Test {
 protected:
  TurnsAmidMotions() { EXPECT_TRUE(world_.run_until_up()) << world_.replay(); }

  // Starts the next motion when the previous one has ended, or was refused because a caller waits for a lease.
  void move_without_a_pause() {
    MoveRequest request = move_of(world_, {{1, forward_ ? kWay : -kWay}}, true);
    request.context = world_.context("mover", seconds(20));
    moving_ = true;
    world_.controller().move(std::move(request), world_.now(), [this](const Result<Motion>& motion) {
      if (!motion) moving_ = false;
    });
    forward_ = !forward_;
  }

  void ask_without_a_pause(const std::string& question, const std::string& who) {
    const TimePoint asked = world_.now();
    world_.controller().execute({{question}, world_.context(who, seconds(20))}, asked,
                                [this, question, who, asked](const ExecuteEvent& event) {
                                  if (event.kind != ExecuteEvent::Kind::ended) return;
                                  EXPECT_FALSE(event.problem) << question << ": " << event.problem->message;
                                  note(question, world_.now() - asked);
                                  due_.push_back([this, question, who] { ask_without_a_pause(question, who); });
                                });
  }

  // Acquires a lease and moves once under it; acquires the next one `pause` after the lease was granted.
  void lease_again_and_again(const std::string& who, Duration pause) {
    const TimePoint asked = world_.now();
    leases_.acquire({.scope = kOne}, who, true, asked + seconds(20), asked,
                    [this, who, pause, asked](const Result<Lease>& got) {
                      ASSERT_TRUE(got) << got.error().message;
                      note("a lease", world_.now() - asked);
                      due_.push_back([this, who, token = got->token] { move_and_release(who, token); });
                      world_.at(world_.now() + pause, [this, who, pause] { lease_again_and_again(who, pause); });
                    });
  }

  // Moves and then releases the lease. The axes are free when the motion has ended.
  void move_and_release(const std::string& who, LeaseToken token) {
    MoveRequest request = move_of(world_, {{1, kWayUnderLease}}, true);
    request.context = world_.context(who, seconds(20));
    request.context.lease = token;
    world_.controller().move(std::move(request), world_.now(), [this, token](const Result<Motion>& motion) {
      EXPECT_TRUE(motion) << motion.error().message;
      due_.push_back([this, token] { EXPECT_TRUE(leases_.release(token, world_.now())); });
    });
  }

  void note(const std::string& what, Duration wait) {
    longest_[what] = std::max(longest_[what], wait);
    ++answers_[what];
  }

  void run_for(Duration duration) {
    const TimePoint end = world_.now() + duration;
    std::size_t ended = world_.outcomes().size();
    while (world_.now() < end) {
      moving_ = moving_ && world_.outcomes().size() == ended;
      ended = world_.outcomes().size();
      if (!moving_) move_without_a_pause();
      for (const auto& again : std::exchange(due_, {})) again();
      world_.run_for(milliseconds(1));
    }
  }

  server::LeaseTokens tokens_{1};
  server::Leases leases_{tokens_};
  World world_{shared_by(leases_)};
  bool forward_ = true, moving_ = false;
  std::vector<std::function<void()>> due_;
  std::map<std::string, Duration> longest_;
  std::map<std::string, int> answers_;
};

TEST_F(TurnsAmidMotions, SixteenAskersOfEachQuestionAndTwoWhoWaitForALease) {
  for (const char* question : kRareQuestions) {
    for (int i = 0; i < kAskers; ++i) ask_without_a_pause(question, "asker-" + std::to_string(i));
  }
  lease_again_and_again("unix anna", milliseconds(2300));
  lease_again_and_again("unix bert", milliseconds(3100));
  run_for(std::chrono::minutes(1));
  EXPECT_EQ(longest_.size(), kRareQuestions.size() + 1);
  for (const auto& [what, wait] : longest_) {
    EXPECT_LE(wait, kLongest) << what << world_.replay();
    RecordProperty(what, std::to_string(wait / milliseconds(1)) + " ms at most, of " + std::to_string(answers_[what]));
  }
  EXPECT_GE(world_.outcomes().size(), 20u) << "the motions did not continue";
}

}  // namespace
}  // namespace axisgate::simulation
