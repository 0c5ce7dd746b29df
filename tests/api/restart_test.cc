// Tests of a restart of the daemon: watchers of events resume, and motions of the previous run are still known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/api/world.h"

namespace axisgate::api {
namespace {

using stage::MotionState;

void with_journal(World& world) { world.journal_config.kept = true; }

// Reads all events up to the newest revision.
std::vector<Event> read_to_newest(World& world, Reader<Event>& reader) {
  std::vector<Event> events;
  do {
    events.push_back(*reader.next());
  } while (events.back()->revision < world.gateway->events().newest_revision());
  return events;
}

TEST(Restart, AWatcherResumesWhereItEnded) {
  World world(with_journal);
  ASSERT_TRUE(world.move(World::by(kAnna), 10));
  ASSERT_TRUE(world.all_ended());
  Reader<Event> reader(*world.api->events.watch(World::by(kAnna), {.from = 0}));
  std::vector<Event> events = read_to_newest(world, reader);
  const std::string run = world.gateway->run();
  EXPECT_TRUE(std::holds_alternative<server::DaemonStarted>(events.front()->fact));
  reader.close();
  world.restart(true);

  const std::uint64_t next = events.back()->revision + 1;
  Reader<Event> resumed(*world.api->events.watch(World::by(kAnna), {.device = kDevice, .run = run, .from = next}));
  const std::vector<Event> after = read_to_newest(world, resumed);
  EXPECT_EQ(after.front()->run, world.gateway->run());
  const auto* started = std::get_if<server::DaemonStarted>(&after.front()->fact);
  ASSERT_NE(started, nullptr) << "of no device, and nevertheless for a watcher of one";
  EXPECT_FALSE(started->after_unclean_end);
  EXPECT_EQ(after.front()->revision, next);
  for (std::size_t i = 1; i < after.size(); ++i) EXPECT_EQ(after[i]->revision, after[i - 1]->revision + 1);

  Reader<Event> all(*world.api->events.watch(World::by(kAnna), {.run = run, .from = 1}));
  const std::vector<Event> again = read_to_newest(world, all);
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(again[i]->revision, events[i]->revision);
    EXPECT_EQ(again[i]->fact.index(), events[i]->fact.index());
    EXPECT_EQ(again[i]->time, events[i]->time);
    EXPECT_EQ(again[i]->run, run);
  }
}

TEST(Restart, AfterAKillAWatcherResumesOverTheGap) {
  World world(with_journal);
  const std::string run = world.gateway->run();
  const std::uint64_t received = world.gateway->events().newest_revision() + 5;
  world.restart(false);
  Reader<Event> resumed(*world.api->events.watch(World::by(kAnna), {.run = run, .from = received + 1}));
  const Event first = *resumed.next();
  EXPECT_TRUE(std::get<server::DaemonStarted>(first->fact).after_unclean_end);
  EXPECT_GT(first->revision, server::journal::FactTable::kUnwrittenMost);
}

TEST(Restart, WithARunThatWasNotKeptItIsCompacted) {
  World world(with_journal);
  world.restart(true);
  Reader<Event> reader(*world.api->events.watch(World::by(kAnna), {.run = "not kept", .from = 2}));
  EXPECT_EQ(reader.reason(), Reason::compacted);
  EXPECT_EQ(reader.end().resume, 1u);
  Reader<Event> later(*world.api->events.watch(World::by(kAnna), {.run = world.gateway->run(), .from = 1}));
  EXPECT_EQ(later.reason(), Reason::compacted) << "revision 1 is of the run before";
}

class MotionOfTheRunBefore : public testing::Test {
 protected:
  MotionOfTheRunBefore() : world_(with_journal) {
    const StartedMotion motion = world_.move(World::by(kAnna), 10);
    EXPECT_TRUE(motion);
    EXPECT_TRUE(world_.all_ended());
    name_ = motion_name("turn", motion->motion.id);
    before_ = get(name_).value();
    world_.restart(true);
  }
  Result<CurrentMotion> get(const std::string& name) {
    Asking<CurrentMotion> asking;
    world_.api->motions.get(World::by(kAnna), name, asking.answer());
    return asking.get();
  }

  World world_;
  std::string name_;
  std::optional<CurrentMotion> before_;
};

TEST_F(MotionOfTheRunBefore, IsAnsweredWithItsOutcome) {
  const Result<CurrentMotion> motion = get(name_);
  ASSERT_TRUE(motion) << motion.error().message;
  EXPECT_EQ(motion->stage->name(), "turn");
  EXPECT_EQ(motion->motion.state, MotionState::succeeded);
  EXPECT_EQ(motion->motion.who, kAnna);
  EXPECT_EQ(motion->revision, before_->revision);
  EXPECT_EQ(motion->clock.at(motion->motion.ended), before_->clock.at(before_->motion.ended));
}

TEST_F(MotionOfTheRunBefore, IsWatchedToItsEnd) {
  Reader<CurrentMotion> reader(*world_.api->motions.watch(World::by(kAnna), name_));
  const auto motion = reader.next();
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->motion.state, MotionState::succeeded);
  EXPECT_EQ(reader.reason(), Reason::unspecified);
}

TEST_F(MotionOfTheRunBefore, AnotherIsNotFoundAndTheJournalIsNamed) {
  const Result<CurrentMotion> motion = get(motion_name("turn", 77));
  ASSERT_FALSE(motion);
  EXPECT_EQ(motion.error().reason, Reason::not_found);
  EXPECT_THAT(motion.error().hint, testing::HasSubstr("`ListHistory`"));
}

}  // namespace
}  // namespace axisgate::api
