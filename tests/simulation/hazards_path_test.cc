// Hazard 56, and other events that a path can take for the end of a segment. Each test fails without the guard that it
// tests (tests/guards/table.cc).
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kSegments = 6;

// Returns a line so fast that a segment sent a few milliseconds too soon overwrites the waiting one.
Setup fast() {
  auto setup = quiet();
  setup.baud = setup.profile.baud = 115200;
  return setup;
}

// Expects that every segment has run once.
void expect_whole(World& world, Duration what) {
  const Motion path = outcome_of(world, 1, seconds(120));
  EXPECT_EQ(path.state, MotionState::succeeded) << what.count() << " ns\n" << world.replay();
  EXPECT_EQ(world.device().starts(2), kSegments) << what.count() << " ns\n" << world.replay();
}

// A flipped bit turns a segment of axes 1 and 2 into one of axes 1 and 3. A doubled axis number makes the gateway check
// before the segment runs.
TEST(Hazard, H07_ASegmentForOtherAxes) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int segments = 0, numbers = 0;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind == LineKind::command && line.starts_with("KP:A") && ++segments == 4) {
      return {.drop = false, .delay = {}, .instead = "KP:B" + line.substr(4) + "\r\n"};
    }
    if (kind == LineKind::notice && line == "1" && ++numbers == 2) {
      return {.drop = false, .delay = {}, .instead = "1\r\n1\r\n"};
    }
    return {};
  });
  world.controller().run_path(line_of(world, kSegments), world.now(), [](Result<Motion>) {});
  const Motion path = outcome_of(world, 1, seconds(120));
  EXPECT_EQ(path.state, MotionState::failed) << world.replay();
  EXPECT_EQ(reason_of(path), Reason::line_fault);
  world.run_for(seconds(5));
  EXPECT_EQ(world.device().starts(3), 0) << world.replay();
  EXPECT_FALSE(world.device().busy(1) || world.device().busy(2) || world.device().busy(3));
}

// The other axis' number of each segment is late by nearly a segment, and comes at the end of the next segment.
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

// Runs a path whose speed the gateway has misread: it believes that each segment takes a third of its time.
void run_misread_path(World& world) {
  const std::string misread = "S3000F50000R100";
  world.wire().set_script([&world, misread](LineKind kind, const std::string&) -> Scripted {
    if (kind != LineKind::reply || world.wire().commands().back() != "?:D") return {};
    return {.drop = false, .delay = {}, .instead = misread + "," + misread + "," + misread + "\r\n"};
  });
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  auto path = line_of(world, kSegments);
  for (auto& segment : path.segments) segment.speed = {};
  world.controller().run_path(path, world.now(), [](Result<Motion>) {});
}

// A number already confirmed by a question is late, in the middle of the next segment.
TEST(Hazard, H56_ALateNumberIsNotTheNextSegmentsEnd) {
  World world(quiet());
  run_misread_path(world);
  world.wire().set_script([numbers = 0](LineKind kind, const std::string& line) mutable -> Scripted {
    const bool second = kind == LineKind::notice && line == "1" && ++numbers == 2;
    return {.drop = false, .delay = second ? milliseconds(1500) : Duration{}, .instead = {}};
  });
  expect_whole(world, milliseconds(1500));
}

// After the late number, the numbers of later segments are believed again. Each that is not believed costs a question.
TEST(Hazard, H56_BehindALateNumberTheNextOnesCount) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int numbers = 0;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    const bool second = kind == LineKind::notice && line == "1" && ++numbers == 2;
    return {.drop = false, .delay = second ? milliseconds(400) : Duration{}, .instead = {}};
  });
  world.controller().run_path(line_of(world, kSegments), world.now(), [](Result<Motion>) {});
  ASSERT_TRUE(world.run_until([&] { return numbers == 3; }, seconds(60))) << world.replay();
  const auto questions = [&] { return std::ranges::count(world.wire().commands(), "?:KP"); };
  const auto asked = questions();
  expect_whole(world, milliseconds(400));
  EXPECT_EQ(questions() - asked, 1) << world.replay();
}

// A line of noise reads as the axis number, inside a barrier and long before the segment's end.
TEST(Hazard, H56_ANumberInABarrierIsChecked) {
  for (int i = 0; i < 40 && !HasFailure(); ++i) {
    World world(quiet());
    run_misread_path(world);
    const int segment = 2 + i % 4;
    ASSERT_TRUE(world.run_until([&] { return world.device().starts(2) == segment; }, seconds(30))) << world.replay();
    world.run_for(milliseconds(200));  // all lines after the segment's start have been answered
    bool deaf = true;
    world.wire().set_script([&](LineKind kind, const std::string&) {
      return Scripted{.drop = deaf && kind == LineKind::reply, .delay = {}, .instead = {}};
    });
    world.controller().execute({{"?:V"}, world.context("asker")}, world.now(), [](const ExecuteEvent&) {});
    world.run_for(milliseconds(600 + 13 * i));
    EXPECT_GT(world.barriers(), 0u) << world.replay();
    world.controller().receive("1\r\n", world.now());
    deaf = false;
    expect_whole(world, milliseconds(i));
  }
}

// The path passes the same places again, so its final place does not show how far it got.
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
