// Hazards of a stop on a line that garbles or loses replies. The numbers are those of device/shrc203/HAZARDS.md.
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

class HazardOfGarbledStops : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    move_by(world, {{1, 1'500'000}});
    world.run_for(milliseconds(300));
    ASSERT_TRUE(world.device().busy(1));
  }

  // Stops, and returns the time from the request to the report.
  Duration stop(std::optional<Duration> limit) {
    const TimePoint asked = world.now();
    auto context = world.context("stopper");
    if (limit) context.answer_by = asked + *limit;
    world.controller().stop({}, context, asked, [this](const StopReport& made) { report = made; });
    EXPECT_TRUE(world.run_until([this] { return report.has_value(); }, seconds(60))) << world.replay();
    return world.now() - asked;
  }

  World world{quiet()};
  std::optional<StopReport> report;
};

// The reply to L: is garbage and every reading of a prebuffer is lost, but the status is received.
TEST_F(HazardOfGarbledStops, H54_AValidStatusIsTheAnswer) {
  std::optional<TimePoint> read;
  world.wire().set_script([&](LineKind kind, const std::string&) -> Scripted {
    if (kind != LineKind::reply) return {};
    const std::string& asked = world.wire().commands().back();
    const bool prebuffer = asked == "?:MP" || asked == "?:AP" || asked == "?:KP" || asked == "?:EP";
    if (asked.starts_with("Q:") && !world.device().busy(1) && !read) read = world.now();
    if (asked.starts_with("L:")) return {.drop = false, .delay = {}, .instead = "O\x83\r\n"};
    return {.drop = prebuffer, .delay = {}, .instead = {}};
  });
  stop({});
  ASSERT_TRUE(read) << world.replay();
  EXPECT_LE(world.now() - *read, seconds(1) + milliseconds(20)) << world.replay();
  EXPECT_FALSE(report->problem) << report->problem->message << "\n" << world.replay();
  EXPECT_LE(written(world, "L:"), 2) << "?:CMD had shown that it was received: the axis had time to slow down\n"
                                     << world.replay();
  EXPECT_TRUE(report->axes[0].reply_unreadable);
  EXPECT_EQ(report->axes[0].wire_reply, "");
  EXPECT_EQ(report->axes[0].ready, true);
  EXPECT_EQ(report->axes[0].position_pulses, world.device().position(1));
}

// No reading succeeds: the caller is notified of that, and of its axes, within the caller's own time limit.
TEST_F(HazardOfGarbledStops, H54_TheCallersLimitIsKept) {
  world.wire().set_script([](LineKind kind, const std::string&) {
    return Scripted{.drop = kind != LineKind::command, .delay = {}, .instead = {}};
  });
  EXPECT_LE(stop(seconds(1)), milliseconds(1001)) << world.replay();
  ASSERT_TRUE(report->problem);
  EXPECT_EQ(report->problem->reason, Reason::outcome_unknown);
  EXPECT_TRUE(report->axes[0].named);
  EXPECT_FALSE(report->axes[0].ready);
  EXPECT_FALSE(report->axes[0].position_pulses);
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
