// Hazard 43: counters that overflow, numbers of more than nine digits, units that pulses cannot express. Requests with
// them are refused before anything is written; from the device, they are never taken for a position.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

constexpr std::int64_t kMost = 999'999'999;  // manual 67) M:
constexpr std::int64_t kHuge = std::numeric_limits<std::int64_t>::max();

class HazardH43 : public testing::Test {
 protected:
  HazardH43() : world(quiet()) { EXPECT_TRUE(world.run_until_up()) << world.replay(); }

  // Returns the reason of the refusal, and expects it at once, with nothing written.
  template <class Ask>
  Reason refused(const Ask& ask) {
    const std::size_t lines = world.wire().commands().size();
    std::optional<Reason> reason;
    ask([&](const Result<Motion>& motion) { reason = motion ? Reason::unspecified : motion.error().reason; });
    EXPECT_TRUE(reason.has_value()) << "not answered at once";
    EXPECT_EQ(world.wire().commands().size(), lines) << world.replay();
    return reason.value_or(Reason::unspecified);
  }

  Reason refused_move(const Quantity& amount, bool relative) {
    return refused([&](const Controller::OnStarted& started) {
      MoveRequest request = move_of(world, {{1, 0}}, relative);
      request.moves[0].distance = amount;
      world.controller().move(std::move(request), world.now(), started);
    });
  }

  World world;
};

TEST_F(HazardH43, TargetsBeyondNineDigits) {
  for (const std::int64_t beyond : {kMost + 1, -kMost - 1, kHuge, -kHuge, kHuge - 1}) {
    EXPECT_EQ(refused_move(pulses(beyond), false), Reason::out_of_range) << beyond;
    EXPECT_EQ(refused_move(pulses(beyond), true), Reason::out_of_range) << beyond;
    EXPECT_EQ(refused_move({{beyond, 0}, Unit::millimeters}, false), Reason::out_of_range) << beyond;
  }
}

// The displacement has nine digits, its end has more.
TEST_F(HazardH43, AWayThatWouldOverflowTheCounter) {
  moved(world, {{1, 1000}});
  EXPECT_EQ(refused_move(pulses(kMost), true), Reason::out_of_range);
  EXPECT_EQ(refused_move(pulses(kMost - 999), true), Reason::out_of_range);
  EXPECT_EQ(world.device().starts(1), 1);
}

TEST_F(HazardH43, APathWhoseSumWouldOverflow) {
  PathRequest path = line_of(world, 3);
  for (auto& segment : path.segments) segment.moves[1].distance = pulses(500'000'000);
  EXPECT_EQ(
      refused([&](const Controller::OnStarted& started) { world.controller().run_path(path, world.now(), started); }),
      Reason::out_of_range);
}

// One pulse is 10 nm: a value between two pulses is not rounded.
TEST_F(HazardH43, UnitsThatPulsesCannotSay) {
  EXPECT_EQ(refused_move({{15, 0}, Unit::nanometers}, true), Reason::not_representable);
  EXPECT_EQ(refused_move({{1, 6}, Unit::millimeters}, true), Reason::not_representable);
  EXPECT_EQ(refused_move({{1, 18}, Unit::millimeters}, true), Reason::not_representable);
  EXPECT_EQ(refused_move({{1, 0}, Unit::degrees}, true), Reason::unknown_unit);
  moved(world, {{1, 0}, {2, 1}});
  MoveRequest exact = move_of(world, {{1, 0}}, true);
  exact.moves[0].distance = {{70, 0}, Unit::nanometers};
  world.controller().move(std::move(exact), world.now(), [](Result<Motion>) {});
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  EXPECT_EQ(world.device().position(1), 7);
}

TEST_F(HazardH43, LinesOfMoreThanNineDigits) {
  for (const char* line : {"M:1+P1000000000", "A:1-P9223372036854775808", "MP:1+P99999999999999999999"}) {
    EXPECT_THAT(execute(world, {line, "G:1"}), ElementsAre(testing::Not("OK"))) << line;
  }
  EXPECT_EQ(motion_lines(world, 0), 0) << world.replay();
}

// Impossible numbers from the device are not believed either: too long, or a jump that no stage can make.
TEST_F(HazardH43, PositionsThatCannotBe) {
  for (const std::string strange :
       {"P+9223372036854775808", "P-99999999999999999999", "P+9223372036854775807", "P+-1", "P+1000000000"}) {
    bool told = false;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      if (told || kind != LineKind::reply || !line.starts_with("P")) return {};
      told = true;
      return {.drop = false, .delay = {}, .instead = strange + line.substr(line.find(',')) + "\r\n"};
    });
    for (int i = 0; i < 4000; ++i) {
      world.run_for(milliseconds(1));
      const auto shown = world.controller().state().axis(1).position_pulses.value_or(0);
      ASSERT_EQ(shown, 0) << strange << "\n" << world.replay();
    }
    EXPECT_TRUE(told) << strange;
    ASSERT_TRUE(world.run_until_up()) << world.replay();
  }
}

}  // namespace
}  // namespace axisgate::simulation
