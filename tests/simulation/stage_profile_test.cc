// Tests of the stage in an axis's profile when another stage is connected. The controller decides the resolution
// (manual 10) ?:P, 55) S:).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;

// The simulated pulse is 10 nm at 200 divisions.
Setup with_pulse_of(std::int64_t nanometers) {
  Setup setup = quiet();
  setup.profile.axes[0].stage = StageProfile{"OSMS20-85", {{nanometers, 0}, false}, {}};
  return setup;
}

class StageOfProfile : public testing::Test {
 protected:
  // Returns the reason of a request's refusal by a world whose axis 1 has another stage.
  Reason refused(const std::function<void(Controller::OnStarted)>& ask) {
    std::optional<Reason> reason;
    ask([&reason](const Result<Motion>& motion) { reason = motion ? Reason::unspecified : motion.error().reason; });
    EXPECT_TRUE(world->run_until([&] { return reason.has_value(); }, seconds(5))) << world->replay();
    return reason.value_or(Reason::internal);
  }

  void start(const simulation::Setup& setup) {
    world = std::make_unique<World>(setup);
    EXPECT_TRUE(world->run_until_up());
  }

  std::unique_ptr<World> world;
};

TEST_F(StageOfProfile, TheOneThatIsThereMoves) {
  start(with_pulse_of(10));
  moved(*world, {{1, 700}});
  home(*world, AxisSet::of(1));
  EXPECT_EQ(outcome_of(*world, 2).state, MotionState::succeeded);
  EXPECT_THAT(execute(*world, {"M:1+P100", "G:1"}), ElementsAre("OK", "OK"));
}

TEST_F(StageOfProfile, AnotherOneIsMovedByNothing) {
  start(with_pulse_of(1000));
  const std::size_t before = world->wire().commands().size();
  const TimePoint now = world->now();
  const AxisSet first = AxisSet::of(1);
  Controller& controller = world->controller();
  using Verdict = Controller::OnStarted;
  const RequestContext context = world->context("tester");
  const std::function<void(Verdict)> requests[] = {
      [&](Verdict told) {
        controller.move(move_of(*world, {{2, 100}, {1, 100}}, true), now, std::move(told));
      },
      [&](Verdict told) {
        controller.move(move_of(*world, {{1, 100}}, false), now, std::move(told));
      },
      [&](Verdict told) { controller.run_path(line_of(*world, 3), now, std::move(told)); },
      [&](Verdict told) {
        controller.jog({{{1, 1, {}}}, context}, now, std::move(told));
      },
      [&](Verdict told) {
        controller.home({first, context}, now, std::move(told));
      },
      [&](Verdict told) {
        controller.home({{}, context}, now, std::move(told));
      },
      [&](Verdict told) {
        controller.return_to_origin({first, context}, now, std::move(told));
      }};
  for (const auto& ask : requests) EXPECT_EQ(refused(ask), Reason::identity_mismatch);
  using Sent = std::vector<std::string>;
  for (const Sent& lines : {Sent{"M:1+P100", "G:1"}, Sent{"AP:1+P100", "G:1"}, Sent{"K:A+P100+P100", "G:A"},
                            Sent{"E:0A0+P100+P100", "G:A"}, Sent{"HRT:1"}, Sent{"H:W"}, Sent{"ZRT:1"},
                            Sent{"WT:1,1", "G:1"}, Sent{"SLEEP:1"}, Sent{"P:R", "P:P1", "P:S", "P:H"}}) {
    EXPECT_EQ(execute(*world, lines).back(), "IDENTITY_MISMATCH") << lines.front();
  }
  EXPECT_EQ(motion_lines(*world, before), 0) << world->replay();
  for (const char* prefix : {"E:", "WT:", "SLEEP", "P:"}) EXPECT_EQ(written(*world, prefix, before), 0) << prefix;
}

TEST_F(StageOfProfile, QuestionsStopsAndTheOtherAxesGoOn) {
  start(with_pulse_of(1000));
  EXPECT_THAT(execute(*world, {"?:P"}), ElementsAre("10,10,10"));
  moved(*world, {{2, 700}});
  EXPECT_FALSE(stopped(*world).problem);
  EXPECT_EQ(written(*world, "L:"), 1) << world->replay();
}

// Manual 55): the resolution has changed afterwards.
TEST_F(StageOfProfile, DivisionsPutItRightAndWrong) {
  start(with_pulse_of(20));
  const auto ask = [this](Controller::OnStarted told) {
    world->controller().move(move_of(*world, {{1, 100}}, true), world->now(), std::move(told));
  };
  EXPECT_EQ(refused(ask), Reason::identity_mismatch);
  EXPECT_THAT(execute(*world, {"S:1,100"}), ElementsAre("OK"));
  world->run_for(milliseconds(500));
  moved(*world, {{1, 100}});
  EXPECT_THAT(execute(*world, {"S:1,200"}), ElementsAre("OK"));
  world->run_for(milliseconds(500));
  EXPECT_EQ(refused(ask), Reason::identity_mismatch);
}

TEST_F(StageOfProfile, AMotionThatHasWaitedIsLookedAtAgain) {
  start(with_pulse_of(10));
  move_by(*world, {{1, 20'000}});
  world->run_for(milliseconds(50));
  world->controller().execute({{"S:1,100"}, world->context("bert")}, world->now(), [](const ExecuteEvent&) {});
  home(*world, AxisSet::of(1));
  ASSERT_TRUE(world->run_until([this] { return world->outcomes().size() >= 3; }, seconds(20))) << world->replay();
  EXPECT_EQ(reason_of(world->outcomes().back()), Reason::identity_mismatch) << world->replay();
  EXPECT_EQ(written(*world, "HRT:"), 0) << world->replay();
}

}  // namespace
}  // namespace axisgate::simulation
