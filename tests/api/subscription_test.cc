// Tests of streams: items that a slow reader misses, the ends of streams, and resuming a stream.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/api/ask.h"

namespace axisgate::api {
namespace {

using stage::MotionState;
using std::chrono::milliseconds;

template <class Item>
Reason refusal(const Opened<Item>& opened) {
  return opened ? Reason::unspecified : opened.error().reason;
}

TEST(DeviceStream, ASlowReaderReceivesTheNewestStateOnly) {
  World world;
  Reader<DeviceState> reader(*world.api->devices.watch(World::by(kAnna), kDevice, Duration()));
  ASSERT_TRUE(reader.next());
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(world.move(World::by(kAnna), 10));
    ASSERT_TRUE(world.all_ended());
  }
  ASSERT_TRUE(comes_true([&] { return world.device().newest_state().get().value->axis(1).position_pulses == 50; }));
  EXPECT_EQ(reader.next()->state->axis(1).position_pulses, 50);
}

TEST(DeviceStream, NoMoreOftenThanAsked) {
  World world;
  const Duration interval = milliseconds(150);
  Reader<DeviceState> reader(*world.api->devices.watch(World::by(kAnna), kDevice, interval));
  ASSERT_TRUE(reader.next());
  const TimePoint first = monotonic_now();
  ASSERT_TRUE(world.move(World::by(kAnna), 10));
  ASSERT_TRUE(world.all_ended());
  EXPECT_FALSE(reader.has_something());
  ASSERT_TRUE(reader.next());
  EXPECT_GE(monotonic_now() - first, interval - milliseconds(5));
}

TEST(DeviceStream, AReaderThatHasGoneIsWokenNoMore) {
  World world;
  Reader<DeviceState> reader(*world.api->devices.watch(World::by(kAnna), kDevice, Duration()));
  ASSERT_TRUE(reader.next());
  reader.close();
  const int before = reader.wake_ups();
  ASSERT_TRUE(world.move(World::by(kAnna), 10));
  ASSERT_TRUE(world.all_ended());
  EXPECT_EQ(reader.wake_ups(), before);
}

TEST(EventStream, EveryFactOnceInOrderAndFromWhereItIsResumed) {
  World world;
  Reader<Event> reader(*world.api->events.watch(World::by(kAnna), {.device = kDevice, .from = 0}));
  ASSERT_TRUE(world.move(World::by(kAnna), 10));
  ASSERT_TRUE(world.all_ended());
  const std::uint64_t newest = world.gateway->events().newest_revision();
  ASSERT_GT(newest, 3u);
  for (std::uint64_t revision = 1; revision <= newest; ++revision) EXPECT_EQ((*reader.next())->revision, revision);
  EXPECT_FALSE(reader.has_something());
  Reader<Event> resumed(*world.api->events.watch(World::by(kAnna), {.run = world.gateway->run(), .from = newest - 1}));
  EXPECT_EQ((*resumed.next())->revision, newest - 1);
  Reader<Event> from_now(*world.api->events.watch(World::by(kAnna), {}));
  EXPECT_FALSE(from_now.has_something());
}

void publish(World& world, std::size_t facts) {
  for (std::size_t i = 0; i < facts; ++i) {
    world.gateway->events().publish("turn", stage::CompletionSeen{.axis = 1}, {}, {});
  }
}

TEST(EventStream, ATooSlowReaderReceivesWhereToResume) {
  World world;
  Reader<Event> reader(*world.api->events.watch(World::by(kAnna), {.from = 0}));
  ASSERT_TRUE(reader.next());
  publish(world, server::EventBus::kFactsKept + 100);
  EXPECT_EQ(reader.reason(), Reason::compacted);
  ASSERT_TRUE(reader.end().resume);
  Reader<Event> resumed(*world.api->events.watch(World::by(kAnna), {.from = *reader.end().resume}));
  EXPECT_EQ((*resumed.next())->revision, *reader.end().resume);
  const std::string metrics = [&] {
    for (const auto& family : world.gateway->metrics().registry()->Collect()) {
      if (family.name.find("slow_readers") != std::string::npos) return std::to_string(family.metric[0].counter.value);
    }
    return std::string();
  }();
  EXPECT_EQ(metrics, "1.000000");
}

TEST(EventStream, ARevisionOfAnotherRun) {
  World world;
  Reader<Event> reader(*world.api->events.watch(World::by(kAnna), {.run = "another", .from = 1}));
  EXPECT_EQ(reader.reason(), Reason::compacted);
  EXPECT_EQ(reader.end().resume, 1u);
  EXPECT_EQ(refusal(world.api->events.watch(World::by(kAnna), {.device = "devices/none"})), Reason::unknown_device);
}

TEST(MotionStream, FromItsStartToItsOutcome) {
  World world;
  const StartedMotion motion = world.move(World::by(kAnna), 2000);
  ASSERT_TRUE(motion);
  Reader<CurrentMotion> reader(*world.api->motions.watch(World::by(kAnna), motion_name("turn", motion->motion.id)));
  std::vector<CurrentMotion> seen;
  while (auto one = reader.next()) seen.push_back(*one);
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back().motion.state, MotionState::succeeded);
  EXPECT_GE(seen.back().revision, seen.front().revision);
  EXPECT_FALSE(reader.end().problem);
}

// The missed events are no longer on the bus, so the reader receives the present state of the motion instead.
TEST(MotionStream, ATooSlowReaderReceivesTheMotionAsItIs) {
  World world;
  const StartedMotion motion = world.move(World::by(kAnna), 2000);
  ASSERT_TRUE(motion);
  Reader<CurrentMotion> reader(*world.api->motions.watch(World::by(kAnna), motion_name("turn", motion->motion.id)));
  ASSERT_TRUE(reader.next());
  ASSERT_TRUE(world.all_ended());
  publish(world, server::EventBus::kFactsKept + 100);
  std::optional<CurrentMotion> last;
  while (auto one = reader.next()) last = one;
  EXPECT_FALSE(reader.end().problem);
  ASSERT_TRUE(last);
  EXPECT_EQ(last->motion.state, MotionState::succeeded);
}

TEST(LeaseStream, TheBoardAtEveryChange) {
  World world;
  Reader<Board> reader(*world.api->leases.watch(World::by(kAnna), kDevice));
  ASSERT_TRUE(reader.next());
  ASSERT_NE(world.lease_of(kAnna), 0u);
  const auto board = reader.next();
  ASSERT_EQ((*board)->held.size(), 1u);
  EXPECT_EQ((*board)->held[0].holder, kAnna);
}

TEST(RecordStream, EndsWithTheNewestLineOrFollows) {
  World world;
  Reader<std::string> kept(*world.api->diagnostics.record(World::by(kAnna), kDevice, false, false));
  std::string text;
  while (auto one = kept.next()) text += *one;
  EXPECT_GT(text.size(), 100u);
  EXPECT_FALSE(kept.end().problem);

  Reader<std::string> following(*world.api->diagnostics.record(World::by(kAnna), kDevice, true, true));
  ASSERT_TRUE(following.next());  // the header
  ASSERT_TRUE(world.move(World::by(kAnna), 10));
  EXPECT_TRUE(following.next());
}

TEST(ReportStream, SaysAllAndEnds) {
  World world;
  const DoorReport door{"door 7\n", [](const server::Stage& device, const stage::State& state) {
                          return device.name() + " " + state.serial_number + "\n";
                        }};
  const std::string serial = world.state().serial_number;
  Reader<std::string> reader(*world.api->diagnostics.report(World::by(kAnna), door));
  std::string text;
  while (auto one = reader.next()) text += *one;
  for (const std::string part : {"== versions ==", "door 7", "== configuration",
                                 "== state of turn ==", "== metrics ==", "== recording of turn ==", "== replaced =="}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(text.find("turn " + serial), std::string::npos) << "its serial number is no secret";
}

TEST(AtTheEndOfTheDaemon, AReaderReceivesWhatIsDueAndThenWhy) {
  World world;
  Reader<Event> events(*world.api->events.watch(World::by(kAnna), {.device = kDevice, .from = 0}));
  const StartedMotion motion = world.move(World::by(kAnna), 10);
  ASSERT_TRUE(motion);
  Reader<CurrentMotion> outcome(*world.api->motions.watch(World::by(kAnna), motion_name("turn", motion->motion.id)));
  ASSERT_TRUE(world.all_ended());
  const std::uint64_t newest = world.gateway->events().newest_revision();
  world.api->streams.end_all();
  std::uint64_t last = 0;
  while (const auto event = events.next()) last = (*event)->revision;
  EXPECT_EQ(last, newest);
  EXPECT_EQ(events.end().problem->reason, Reason::daemon_ending);
  EXPECT_EQ(outcome.reason(), Reason::unspecified) << "it ends with the outcome of its motion";
}

TEST(AtTheEndOfTheDaemon, EveryKindOfStreamSaysSo) {
  World world;
  const StartedMotion motion = world.move(World::by(kAnna), 1'000'000);
  ASSERT_TRUE(motion);
  const Credential anna{.who = kAnna};
  Reader<DeviceState> device(*world.api->devices.watch(World::by(kAnna), kDevice, Duration()));
  Reader<CurrentMotion> running(*world.api->motions.watch(World::by(kAnna), motion_name("turn", motion->motion.id)));
  Reader<Board> leases(*world.api->leases.watch(World::by(kAnna), kDevice));
  Reader<std::string> recording(*world.api->diagnostics.record(World::by(kAnna), kDevice, true, true));
  Reader<CurrentMotion> jog(*world.api->jogs.open(anna));
  Reader<PathStep> path(*world.api->paths.open(anna));
  world.api->streams.end_all();
  for (const Reason reason :
       {device.reason(), running.reason(), leases.reason(), recording.reason(), jog.reason(), path.reason()}) {
    EXPECT_EQ(reason, Reason::daemon_ending);
  }
}

// Each stream takes one place of the quota, and returns it at its end.
TEST(StreamPlaces, AreTakenAndGivenBack) {
  World world;
  std::vector<std::shared_ptr<Path>> paths;
  const Credential anna{.who = "unix anna"}, ben{.who = "unix ben"};
  for (int i = 0; i < Streams::kPathsOfOneMax; ++i) paths.push_back(*world.api->paths.open(anna));
  EXPECT_EQ(world.api->paths.open(anna).error().reason, Reason::queue_full);
  EXPECT_TRUE(world.api->jogs.open(anna));
  EXPECT_TRUE(world.api->paths.open(ben));
  paths.pop_back();
  EXPECT_TRUE(world.api->paths.open(anna));
}

}  // namespace
}  // namespace axisgate::api
