// Hazard 56 and what else a path can take for the end of a segment. Each of these fails without the guard that it is
// about (tests/guards/table.cc).
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kSegments = 6;

// Fast enough for a segment that is sent a few milliseconds too soon to overwrite the one that waits.
Setup fast() {
  auto setup = quiet();
  setup.baud = setup.profile.baud = 115200;
  return setup;
}

// Every segment has run once, and nothing was lost on the way.
void expect_whole(World& world, Duration what) {
  const Motion path = outcome_of(world, 1, seconds(120));
  EXPECT_EQ(path.state, MotionState::succeeded) << what.count() << " ns\n" << world.replay();
  EXPECT_EQ(world.device().starts(2), kSegments) << what.count() << " ns\n" << world.replay();
}

// The other axis' number of each segment comes nearly a segment late, at the time of the next one's end.
TEST(Hazard, H56_OneAxisIsTheClock) {
  for (Duration late = milliseconds(60); late < milliseconds(260) && !testing::Test::HasFailure();
       late += microseconds(500)) {
    World world(fast());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      return {.drop = false, .delay = kind == LineKind::notice && line == "2" ? late : Duration{}, .instead = {}};
    });
    world.controller().run_path(line_of(world, kSegments), world.now(), [](Result<Motion>) {});
    expect_whole(world, late);
  }
}

// A number that had been asked for comes late, at the time of the next one's end.
TEST(Hazard, H56_ALateNumberIsNotTheNextSegmentsEnd) {
  for (Duration late = milliseconds(120); late < milliseconds(700) && !testing::Test::HasFailure();
       late += milliseconds(5)) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    world.wire().set_script([&, numbers = 0](LineKind kind, const std::string& line) mutable -> Scripted {
      const bool second = kind == LineKind::notice && line == "1" && ++numbers == 2;
      return {.drop = false, .delay = second ? late : Duration{}, .instead = {}};
    });
    auto path = line_of(world, kSegments);
    for (auto& segment : path.segments) segment.speed = pulses(10000);
    world.controller().run_path(path, world.now(), [](Result<Motion>) {});
    expect_whole(world, late);
  }
}

// A line of noise reads as the axis number, inside a barrier and a little before the segment's end.
TEST(Hazard, H56_ANumberInABarrierIsChecked) {
  const auto slow_path = [](World& world) {
    auto path = line_of(world, kSegments);
    for (auto& segment : path.segments) segment.speed = pulses(1000);
    world.controller().run_path(path, world.now(), [](Result<Motion>) {});
  };
  const auto run_to_segment = [](World& world, int number) {
    return world.run_until([&world, number] { return world.device().starts(2) == number; }, seconds(20));
  };
  World measured(fast());
  ASSERT_TRUE(measured.run_until_up()) << measured.replay();
  slow_path(measured);
  ASSERT_TRUE(run_to_segment(measured, 2)) << measured.replay();
  const TimePoint began = measured.now();
  ASSERT_TRUE(run_to_segment(measured, 3)) << measured.replay();
  const Duration lasts = measured.now() - began;
  for (Duration early = microseconds(200); early < milliseconds(12) && !HasFailure(); early += microseconds(300)) {
    World world(fast());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    slow_path(world);
    ASSERT_TRUE(run_to_segment(world, 2)) << world.replay();
    world.run_for(lasts - milliseconds(900));
    bool deaf = true;
    world.wire().set_script([&](LineKind kind, const std::string&) {
      return Scripted{.drop = deaf && kind == LineKind::reply, .delay = {}, .instead = {}};
    });
    world.controller().execute({{"?:V"}, world.context("asker")}, world.now(), [](const ExecuteEvent&) {});
    world.run_for(milliseconds(900) - early);
    EXPECT_GT(world.barriers(), 0u) << world.replay();
    world.controller().receive("1\r\n", world.now());
    deaf = false;
    expect_whole(world, early);
  }
}

// A path that comes through the same places again: where it rests does not tell how far it came.
TEST(Hazard, H56_APlaceThatTwoSegmentsShare) {
  for (int lost = 1; lost <= kSegments && !HasFailure(); ++lost) {
    for (const std::string prefix : {"MP:", "G:"}) {
      for (const auto kind_lost : {LineKind::command, LineKind::reply}) {
        World world(fast());
        ASSERT_TRUE(world.run_until_up()) << world.replay();
        PathRequest path;
        path.context = world.context("tester");
        for (int i = 0; i < kSegments; ++i) {
          path.segments.push_back({{{2, pulses(i % 2 ? -1000 : 1000), {}}}, true, pulses(20000), {}});
        }
        world.wire().set_script([&, lines = 0](LineKind kind, const std::string& line) mutable -> Scripted {
          const std::string& command = kind == LineKind::reply ? world.wire().commands().back() : line;
          const bool hit = kind == kind_lost && command.starts_with(prefix) && ++lines == lost;
          return {.drop = hit, .delay = {}, .instead = {}};
        });
        world.controller().run_path(path, world.now(), [](Result<Motion>) {});
        const Motion ended = outcome_of(world, 1, seconds(120));
        EXPECT_TRUE(ended.state == MotionState::unknown || world.device().starts(2) == kSegments)
            << prefix << lost << ": " << world.device().starts(2) << " segments ran\n"
            << world.replay();
      }
    }
  }
}

}  // namespace
}  // namespace axisgate::simulation
