// Hazards of repeated requests, also to a daemon that was killed in between. The numbers are those of
// device/shrc203/HAZARDS.md.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "server/api/request/motion_watch.h"
#include "tests/simulation/daemon.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using server::journal::Database;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr std::int64_t kWay = 3000;
constexpr const char* kId = "align-17";
constexpr const char* kAnna = "unix anna";

struct Answer {
  Reason reason = Reason::unspecified;
  Motion motion{};
  bool is_repeated = false;
};

// A daemon with a stage on a good line, and the answers to anna.
struct Bed {
  Bed() {
    daemon->prepare(world.controller(), world.now());
    world.on_news = [this](const Event& event) {
      daemon->on_event(event, world.now());
      if (std::holds_alternative<BytesWritten>(event) && lines_to_kill > 0 && --lines_to_kill == 0) {
        world.at(world.now(), [this] { kill(); });
      }
    };
  }

  Setup setup() const {
    Setup quiet_one = quiet();
    quiet_one.permission = &daemon->leases();
    return quiet_one;
  }

  void kill() {
    ++run;
    world.restart_gateway({.start = [this]() -> Permission& {
                             const bool rows_lost = daemon->disk_hangs();
                             daemon.reset();
                             if (rows_lost) folder.put_journal_back();
                             daemon = std::make_unique<Daemon>(folder, server::journal::MemoryBounds{}, run);
                             return daemon->leases();
                           },
                           .prepare = [this](Controller& controller) { daemon->prepare(controller, world.now()); },
                           .away = milliseconds(300),
                           .written_is_lost = written_is_lost});
  }

  // Requests a move of axis 1 by `way`, like api::Pipeline::act().
  void request(const std::string& id, std::uint64_t device_epoch = 0) {
    const auto begun = daemon->requests().begin(
        {.identity = kAnna, .id = id, .digest = "by the way", .device = kDevice, .moves = true}, "", world.now(),
        [this](const auto& known) {
          const auto motion = known ? api::motion_of(*known, world.controller()) : tl::unexpected(known.error());
          answers.push_back(motion ? Answer{.motion = *motion, .is_repeated = true} : Answer{motion.error().reason});
        });
    if (!begun || !*begun) return;
    const auto mutation = std::make_shared<Mutation>(*daemon, **begun);
    const auto answer = [this, mutation](const Result<Motion>& motion) {
      motion ? mutation->acted({}) : static_cast<void>(mutation->failed(motion.error()));
      answers.push_back(motion ? Answer{.motion = *motion} : Answer{motion.error().reason});
    };
    if (const auto kept = mutation->intend(world.now()); !kept) return answer(tl::unexpected(kept.error()));
    MoveRequest move = move_of(world, {{1, way}}, true);
    move.context.who = kAnna;
    move.context.request_id = id;
    move.context.device_epoch = device_epoch;
    world.controller().move(std::move(move), world.now(), answer);
  }

  Answer answer_to(const std::string& id, std::uint64_t device_epoch = 0) {
    const std::size_t before = answers.size();
    request(id, device_epoch);
    EXPECT_TRUE(world.run_until([&] { return answers.size() > before; }, seconds(20))) << world.replay();
    return answers.size() > before ? answers.back() : Answer{};
  }

  StateFolder folder;
  std::uint32_t run = 1;
  std::unique_ptr<Daemon> daemon = std::make_unique<Daemon>(folder, server::journal::MemoryBounds{}, run);
  World world{setup()};
  std::vector<Answer> answers;
  std::int64_t way = kWay;
  int lines_to_kill = 0;  // 0: no kill
  bool written_is_lost = false;
};

void alter(const Bed& bed, const char* sql) {
  ASSERT_TRUE(Database::open(bed.folder.journal(), Database::Access::write)->run(sql)) << sql;
}

// Data that a killed daemon loses: the line that it was writing, and the rows that waited for the disk.
struct Loss {
  bool line = false, rows = false;
};

class HazardH34 : public testing::TestWithParam<Loss> {};

// Anna repeats her move until she has its outcome.
TEST_P(HazardH34, ARelativeMoveIsRepeatedOverAKillAtAnyLine) {
  int moved_once = 0, done_again = 0;
  for (int line = 1; line <= 24 && !HasFailure(); ++line) {
    Bed bed;
    ASSERT_TRUE(bed.world.run_until_up());
    bed.lines_to_kill = line;
    bed.written_is_lost = GetParam().line;
    bed.request(kId);
    if (GetParam().rows) bed.daemon->let_disk_hang();
    ASSERT_TRUE(bed.world.run_until([&] { return bed.run == 2; }, seconds(20))) << bed.world.replay();
    ASSERT_TRUE(bed.world.run_until_up());
    const Answer repeated = bed.answer_to(kId);
    bed.world.run_for(seconds(3));
    const Answer last = bed.answer_to(kId);
    EXPECT_TRUE(last.is_repeated) << line;
    EXPECT_TRUE(is_outcome(last.motion.state)) << line;
    EXPECT_EQ(last.motion.id, repeated.motion.id) << line;
    if (!bed.answers.front().is_repeated) {
      EXPECT_EQ(last.motion.id, bed.answers.front().motion.id) << "it was answered otherwise before line " << line;
    }
    EXPECT_LE(bed.world.device().starts(1), 1) << line << "\n" << bed.world.replay();
    if (last.motion.state == MotionState::succeeded) {
      EXPECT_EQ(bed.world.device().position(1), kWay) << line;
    }
    moved_once += bed.world.device().starts(1);
    done_again += repeated.is_repeated ? 0 : 1;
  }
  EXPECT_GT(moved_once, 0);
  EXPECT_GT(done_again, 0) << "of a motion that was not sent the id is free";
}

INSTANTIATE_TEST_SUITE_P(Lost, HazardH34, testing::Values(Loss{}, Loss{.line = true}, Loss{.rows = true}));

// By the record, the motion belongs to the gateway, so it is stopped. A repeat of its request is answered with its
// outcome.
TEST(Hazard, H30_AMotionOfAKilledDaemonIsStoppedAndNotResumed) {
  Bed bed;
  ASSERT_TRUE(bed.world.run_until_up());
  bed.way = 500'000;
  const MotionId motion = bed.answer_to(kId).motion.id;
  bed.world.run_for(seconds(1));
  bed.kill();
  ASSERT_TRUE(bed.world.run_until_up()) << bed.world.replay();
  bed.world.run_for(seconds(2));
  EXPECT_GE(written(bed.world, "L:"), 1) << bed.world.replay();
  EXPECT_FALSE(bed.world.device().busy(1)) << bed.world.replay();
  const std::int64_t place = bed.world.device().position(1);
  EXPECT_LT(place, bed.way);
  const std::size_t first = bed.world.wire().commands().size();
  const Answer answer = bed.answer_to(kId);
  EXPECT_TRUE(answer.is_repeated);
  EXPECT_EQ(answer.motion.id, motion);
  EXPECT_EQ(answer.motion.state, MotionState::unknown);
  bed.world.run_for(seconds(5));
  EXPECT_EQ(motion_lines(bed.world, first), 0) << bed.world.replay();
  EXPECT_EQ(bed.world.device().position(1), place);
  const auto ends = bed.daemon->journal().read({.motion = motion, .outcome = "UNKNOWN"}, 10);
  ASSERT_TRUE(ends);
  EXPECT_EQ(ends->size(), 1u);
}

// A request executed before the restart is answered with its result. A new request that names the old epoch is refused.
TEST(Hazard, H21_ARequestOfTheEpochBeforeDoesNotAct) {
  Bed bed;
  ASSERT_TRUE(bed.world.run_until_up());
  const std::uint64_t epoch = bed.world.controller().state().device_epoch;
  const MotionId motion = bed.answer_to(kId, epoch).motion.id;
  ASSERT_EQ(outcome_of(bed.world, 1).state, MotionState::succeeded);
  bed.world.power_cycle();
  ASSERT_TRUE(bed.world.run_until([&] { return bed.world.controller().state().device_epoch > epoch; }, seconds(12)));
  ASSERT_TRUE(bed.world.run_until_up());
  const std::size_t first = bed.world.wire().commands().size();
  const Answer answer = bed.answer_to(kId, epoch);
  EXPECT_TRUE(answer.is_repeated);
  EXPECT_EQ(answer.motion.id, motion);
  EXPECT_EQ(bed.answer_to("align-18", epoch).reason, Reason::epoch_passed);
  bed.world.run_for(seconds(2));
  EXPECT_EQ(motion_lines(bed.world, first), 0) << bed.world.replay();
}

// The disk refuses the row of the request, so nothing is sent. A stop waits for no row. The id stays free.
TEST(Hazard, H45_AFullDiskRefusesMotionsAndNoStop) {
  Bed bed;
  ASSERT_TRUE(bed.world.run_until_up());
  move_for(bed.world, kAnna, {{2, 500'000}});
  ASSERT_TRUE(bed.world.run_until([&] { return bed.world.device().busy(2); }, seconds(5)));
  alter(bed, "ALTER TABLE entry RENAME TO away");
  const std::size_t first = bed.world.wire().commands().size();
  EXPECT_EQ(bed.answer_to(kId).reason, Reason::journal_unavailable);
  bed.world.run_for(seconds(2));
  EXPECT_EQ(motion_lines(bed.world, first), 0) << bed.world.replay();
  EXPECT_FALSE(stopped(bed.world).problem);
  EXPECT_FALSE(bed.world.device().busy(2)) << bed.world.replay();
  alter(bed, "ALTER TABLE away RENAME TO entry");
  bed.kill();
  ASSERT_TRUE(bed.world.run_until_up());
  bed.daemon->leases().rearm(0, kAnna, bed.world.now());
  const Answer answer = bed.answer_to(kId);
  EXPECT_FALSE(answer.is_repeated);
  bed.world.run_for(seconds(3));
  EXPECT_EQ(bed.world.device().position(1), kWay) << bed.world.replay();
}

// The record of motions keeps the newest that have ended, and the number up to which others were started.
TEST(Hazard, H34_MoreMotionsThanTheRecordKeepsEndBehindAHangingDisk) {
  constexpr int kMotions = 24;
  Bed bed;
  ASSERT_TRUE(bed.world.run_until_up());
  for (int i = 0; i < kMotions; ++i) bed.request("align-" + std::to_string(i));
  bed.daemon->let_disk_hang();
  const auto all_ended = [&] { return bed.world.outcomes().size() == kMotions; };
  ASSERT_TRUE(bed.world.run_until(all_ended, seconds(60))) << bed.world.replay();
  bed.kill();
  ASSERT_TRUE(bed.world.run_until_up());
  for (int i = 0; i < kMotions; ++i) bed.request("align-" + std::to_string(i));
  bed.world.run_for(seconds(30));
  EXPECT_EQ(bed.world.device().starts(1), kMotions) << bed.world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
