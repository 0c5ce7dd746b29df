// Hazards of waits, sleep, dialects and non-host modes. The numbers are those of device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "device/shot/command/command.h"
#include "device/shrc203/command/command_table.h"
#include "server/access/leases.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::HasSubstr;
using Lines = std::vector<std::string>;

// A command that can cause motion needs the lease of all axes concerned.
class HazardOfHiddenMotion : public testing::TestWithParam<const char*> {};

TEST_P(HazardOfHiddenMotion, NeedsTheRightToMove) {
  server::LeaseTokens tokens{1};
  server::Leases leases{tokens};
  auto setup = quiet();
  setup.permission = &leases;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  leases.acquire({.scope = AxisSet::of(1)}, "anna", false, world.now(), world.now(),
                 [](const Result<server::Lease>& got) { EXPECT_TRUE(got); });
  const std::size_t lines = world.wire().commands().size();
  EXPECT_THAT(execute(world, {GetParam()}), ElementsAre("LEASE_HELD"));
  EXPECT_EQ(written(world, std::string_view(GetParam()).substr(0, 3), lines), 0) << world.replay();
  const auto row = model().parse(GetParam());
  ASSERT_TRUE(row);
  EXPECT_TRUE(row->row->moves());
}

// 15: the end of a wait starts the setpoint in the prebuffer. 26: a stage that wakes up returns to its place.
INSTANTIATE_TEST_SUITE_P(H15H26, HazardOfHiddenMotion, testing::Values("WT:1,0", "WI:1,C", "WT:W,0", "SLEEP:0"));

TEST(Hazard, H15_AWaitLeftBehindIsRefused) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(execute(world, {"WT:1,5"}), ElementsAre("INCOMPLETE_TRANSACTION"));
  EXPECT_EQ(written(world, "WT:"), 0) << world.replay();
}

TEST(Hazard, H15_AWaitInAChain) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const auto heard = execute(world, {"MP:1+P1000", "G:1", "WT:1,5"});
  EXPECT_EQ(world.device().position(1), 1000) << world.replay();
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::succeeded) << world.replay();
  moved(world, {{1, 100}});
}

TEST(Hazard, H16_InputsStartNothing) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(execute(world, {"WI:1,3", "MP:1+P100", "G:1"}), ElementsAre("NOT_ALLOWED"));
  EXPECT_EQ(written(world, "WI:"), 0) << world.replay();
}

TEST(Hazard, H16_NorDoTheyInAPath) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  PathRequest path = line_of(world, 3);
  path.segments[1].inputs = 0;
  const auto checked = world.controller().check(path);
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().reason, Reason::not_allowed);
  EXPECT_THAT(checked.error().message, HasSubstr("segment 2"));
  Reason refused{};
  world.controller().run_path(path, world.now(), [&](const Result<Motion>& motion) {
    if (!motion) refused = motion.error().reason;
  });
  world.run_for(seconds(1));
  EXPECT_EQ(refused, Reason::not_allowed);
  EXPECT_EQ(motion_lines(world, 0), 0) << world.replay();
}

// C is also a letter for axes, and a line that cancels one wait may set another.
TEST(Hazard, H16_NoWayRound) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(execute(world, {"MP:C+P100+P100", "G:C", "WI:C,5,5"}), ElementsAre("NOT_ALLOWED"));
  EXPECT_THAT(execute(world, {"WI:A,C,5"}), ElementsAre("INVALID_REQUEST"));
  EXPECT_THAT(execute(world, {"WT:A,0,50"}), ElementsAre("INVALID_REQUEST"));
  EXPECT_THAT(execute(world, {"WT:C,5,5"}), ElementsAre("INCOMPLETE_TRANSACTION"));
  EXPECT_THAT(execute(world, {"P:R", "P:ON", "P:SET,1,INPUT,1", "P:OFF", "P:H"}), ElementsAre("NOT_ALLOWED"));
  EXPECT_EQ(written(world, "W") + written(world, "P:"), 0) << world.replay();
}

TEST(Hazard, H16_ArmedIsTold) {
  auto setup = quiet();
  setup.profile.wait_for_inputs = true;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  bool armed = false;
  world.on_news = [&](const Event&) { armed = armed || world.controller().state().axis(1).armed; };
  world.controller().execute({{"MP:1+P1000", "G:1", "WI:1,3"}, world.context("anna")}, world.now(),
                             [](const ExecuteEvent&) {});
  world.run_for(seconds(2));
  EXPECT_TRUE(armed) << world.replay();
  EXPECT_FALSE(stopped(world).problem) << world.replay();
  (void)outcome_of(world, 1);
  EXPECT_FALSE(world.controller().state().axis(1).armed) << world.replay();
}

// The gateway sends only commands that work in every dialect, and reports a fault, until a person has set the dialect
// back. It guesses nothing.
TEST(Hazard, H23_AnotherDialect) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(execute(world, {"FMT:HIT"}), testing::Contains("OK"));
  world.run_for(seconds(10));
  EXPECT_NE(world.controller().state().link, LinkState::up);
  EXPECT_THAT(world.controller().state().link_problem, HasSubstr("HIT"));
  const std::size_t lines = world.wire().commands().size();
  move_by(world, {{1, 1000}});
  world.run_for(seconds(10));
  EXPECT_EQ(motion_lines(world, lines), 0) << world.replay();
  world.device().set_format("SHOT_FC", world.now());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 1000}});
}

TEST(Hazard, H24_MemorySwitchesAreReachedAlone) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const auto epoch = world.controller().state().device_epoch;
  bool ended = false;
  for (const char* question : {"?:V", "?:N", "?:SN", "?:P", "?:C", "?:BEEP", "?:BO", "Q:", "!:S", "SRQ:"}) {
    world.controller().execute({{question}, world.context(question)}, world.now(), [](const ExecuteEvent&) {});
  }
  world.controller().execute({{"MS:ON", "MS:GET,0,4", "MS:SET,0,4,0", "MS:GETK,0", "MS:OFF"}, world.context("admin")},
                             world.now(), [&](const ExecuteEvent& event) {
                               if (event.kind != ExecuteEvent::Kind::ended) return;
                               ended = true;
                               EXPECT_FALSE(event.problem) << event.problem->message << "\n" << world.replay();
                             });
  // Other callers ask questions all the time, and so does the gateway.
  int refused = 0;
  while (!ended && world.now() < TimePoint(std::chrono::minutes(5))) {
    world.controller().execute({{"?:D"}, world.context("other")}, world.now(), [&](const ExecuteEvent& event) {
      refused += event.problem && event.problem->reason == Reason::wrong_mode ? 1 : 0;
    });
    world.controller().refresh({}, world.context("third"), world.now(), [](const Result<State>&) {});
    world.run_for(milliseconds(7));
  }
  EXPECT_TRUE(ended);
  EXPECT_GT(refused, 0);
  const auto& sent = world.wire().commands();
  const auto on = std::ranges::find(sent, "MS:ON"), off = std::ranges::find(sent, "MS:OFF");
  ASSERT_NE(off, sent.end()) << world.replay();
  EXPECT_TRUE(std::all_of(on, off + 1, [](const std::string& line) { return line.starts_with("MS:"); }))
      << "something went between\n"
      << world.replay();
  ASSERT_TRUE(world.run_until([&] { return world.controller().state().device_epoch > epoch; }, seconds(20)))
      << "the settings were not read anew\n"
      << world.replay();
  moved(world, {{1, 100}});
}

class HazardOfTheWayBack : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(HazardOfTheWayBack, IsInTheSameLines) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(execute(world, GetParam()), ElementsAre("INCOMPLETE_TRANSACTION"));
  EXPECT_EQ(written(world, "MS:") + written(world, "P:"), 0) << world.replay();
}

INSTANTIATE_TEST_SUITE_P(H24H25, HazardOfTheWayBack,
                         testing::Values(Lines{"MS:ON"}, Lines{"MS:OFF"}, Lines{"MS:GET,0,1"}, Lines{"P:R"},
                                         Lines{"P:R", "P:ON", "P:H"}, Lines{"P:R", "P:ON", "P:OFF"},
                                         Lines{"MS:ON", "MS:OFF", "P:S"}, Lines{"P:S"}));

TEST(Hazard, H25_NoMotionOnTheWay) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  for (const Lines& lines :
       {Lines{"MS:ON", "M:1+P100", "G:1", "MS:OFF"}, Lines{"P:R", "P:H", "MP:1+P900", "G:1"},
        Lines{"MP:1+P900", "G:1", "MS:ON", "MS:OFF"}, Lines{"MODE:MANUAL", "?:D"}, Lines{"P:R", "P:U1", "P:H"}}) {
    EXPECT_THAT(execute(world, lines), ElementsAre("INVALID_REQUEST")) << lines.front();
  }
  EXPECT_EQ(written(world, "M") + written(world, "P:"), 0) << world.replay();
}

// The line is lost in a non-host mode: the gateway ends the visit that it has begun.
TEST(Hazard, H24_TheWayBackAfterALossOfTheLine) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.controller().execute({{"MS:ON", "MS:GET,0,4", "MS:OFF"}, world.context("admin")}, world.now(),
                             [](const ExecuteEvent&) {});
  ASSERT_TRUE(world.run_until([&] { return written(world, "MS:GET") == 1; }, seconds(5))) << world.replay();
  world.wire().cut(world.now(), seconds(1));
  world.run_for(seconds(3));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_EQ(world.controller().state().mode, "HOST");
  EXPECT_EQ(written(world, "MS:OFF"), 1) << world.replay();
  moved(world, {{1, 100}});
}

const Lines kProgram = {"P:R",  "P:P1", "P:ON", "P:INIT", "P:SET,1,M,1,0,0,500000,0,0,0,1,0,5", "P:SET,2,END", "P:OFF",
                        "P:C0", "P:T0", "P:S",  "P:H"};

TEST(Hazard, H25_AProgramRunsAlone) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  bool ended = false;
  world.controller().execute({kProgram, world.context("admin")}, world.now(), [&](const ExecuteEvent& event) {
    if (event.kind != ExecuteEvent::Kind::ended) return;
    ended = true;
    EXPECT_FALSE(event.problem) << event.problem->message << "\n" << world.replay();
  });
  MoveRequest waits = move_of(world, {{2, 100}}, true);
  waits.context.not_after = world.now() + seconds(60);
  world.controller().move(waits, world.now(), [](const Result<Motion>&) {});
  ASSERT_TRUE(world.run_until([&] { return ended; }, seconds(60))) << world.replay();
  EXPECT_EQ(world.device().position(1), 500'000) << world.replay();
  EXPECT_EQ(world.device().position(2), 0) << "it moved beside the program\n" << world.replay();
  EXPECT_EQ(outcome_of(world, 2).state, MotionState::succeeded) << world.replay();
  moved(world, {{1, 100}});
}

TEST(Hazard, H25_AStopEndsTheProgram) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  Reason told = Reason::unspecified;
  world.controller().execute({kProgram, world.context("admin")}, world.now(), [&](const ExecuteEvent& event) {
    if (event.problem) told = event.problem->reason;
  });
  ASSERT_TRUE(world.run_until([&] { return world.device().busy(1); }, seconds(10))) << world.replay();
  world.run_for(seconds(1));
  EXPECT_FALSE(stopped(world).problem) << world.replay();
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
  EXPECT_LT(world.device().position(1), 500'000);
  EXPECT_EQ(written(world, "P:E"), 1) << world.replay();
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::stopped) << world.replay();
  EXPECT_EQ(told, Reason::stopped);
  EXPECT_EQ(world.controller().state().mode, "HOST");
  moved(world, {{1, 100}});
}

// The controller has accepted the command whose answer is lost: the return to HOST depends on the reply to ?:MODE.
class HazardOfLostAnswers : public testing::TestWithParam<const char*> {};

TEST_P(HazardOfLostAnswers, TheWayBackIsFound) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.wire().set_script(drop_first(world, LineKind::reply, GetParam()));
  const bool switches = std::string_view(GetParam()).starts_with("MS");
  const Lines lines =
      switches ? Lines{"MS:ON", "MS:GETK,0", "MS:OFF"} : Lines{"P:R", "P:ON", "P:GET,1", "P:OFF", "P:H"};
  bool ended = false;
  world.controller().execute({lines, world.context("admin")}, world.now(), [&](const ExecuteEvent& event) {
    ended = ended || event.kind == ExecuteEvent::Kind::ended;
  });
  ASSERT_TRUE(world.run_until([&] { return ended; }, seconds(60))) << world.replay();
  world.run_for(seconds(5));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_EQ(world.controller().state().mode, "HOST") << world.replay();
  moved(world, {{1, 100}});
}

INSTANTIATE_TEST_SUITE_P(H24H25, HazardOfLostAnswers,
                         testing::Values("P:R", "P:ON", "P:GET", "P:OFF", "P:H", "MS:ON", "MS:GETK", "MS:OFF"));

TEST(Hazard, H25_AProgramWhoseLineWasLostIsEnded) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.controller().execute({kProgram, world.context("admin")}, world.now(), [](const ExecuteEvent&) {});
  ASSERT_TRUE(world.run_until([&] { return world.device().busy(1); }, seconds(10))) << world.replay();
  world.wire().cut(world.now(), seconds(1));
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::unknown) << world.replay();
  world.run_for(seconds(3));
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_FALSE(world.device().busy(1)) << world.replay();
  EXPECT_LT(world.device().position(1), 500'000);
  EXPECT_EQ(world.controller().state().mode, "HOST");
}

// Saving takes long, and does not count as a restart.
TEST(Hazard, H25_SavingTakesLong) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const auto epoch = world.controller().state().device_epoch;
  world.wire().set_script([&](LineKind kind, const std::string&) -> Scripted {
    const std::string& line = world.wire().commands().back();
    const bool saves = kind == LineKind::reply && (line == "P:INIT" || line == "P:OFF");
    return {.drop = false, .delay = milliseconds(saves ? 3000 : 0), .instead = {}};
  });
  EXPECT_THAT(execute(world, {"P:R", "P:ON", "P:INIT", "P:OFF", "P:H"}), testing::Each("OK"));
  world.run_for(seconds(5));
  EXPECT_EQ(world.controller().state().link, LinkState::up) << world.replay();
  EXPECT_EQ(world.controller().state().device_epoch, epoch) << world.replay();
}

// A program that gives a trigger pulse every 1000 pulses of 100000, and reports each trigger pulse and its own end.
const Lines kTellingProgram = {"P:R",         "P:P1",  "P:ON", "P:INIT", "P:SET,1,M,1,0,0,100000,0,0,0,1,0,0,1,1000",
                               "P:SET,2,END", "P:OFF", "P:C1", "P:T1",   "P:S",
                               "P:H"};

struct Noticed {
  std::vector<std::int64_t> triggers;  // counts of the triggers in each event
  int ends = 0, barriers = 0;
};

Noticed run_telling_program(World& world) {
  Noticed noticed;
  world.on_news = [&](const Event& event) {
    if (std::holds_alternative<BarrierEntered>(event)) ++noticed.barriers;
    const auto* notice = std::get_if<ProgramNotice>(&event);
    if (!notice) return;
    if (notice->kind == ProgramNotice::Kind::trigger) noticed.triggers.push_back(notice->count);
    if (notice->kind == ProgramNotice::Kind::ended) ++noticed.ends;
  };
  EXPECT_THAT(execute(world, kTellingProgram), testing::Each("OK")) << world.replay();
  world.run_for(seconds(1));
  return noticed;
}

TEST(Hazard, H25_NoticesAreNoAnswers) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const Noticed noticed = run_telling_program(world);
  EXPECT_EQ(world.device().position(1), 100'000) << world.replay();
  EXPECT_EQ(noticed.barriers, 0) << world.replay();
  EXPECT_EQ(noticed.ends, 1) << world.replay();
  EXPECT_EQ(world.device().trigger_pulses(), 100);
  EXPECT_EQ(std::accumulate(noticed.triggers.begin(), noticed.triggers.end(), std::int64_t{0}), 100) << world.replay();
  moved(world, {{1, 100}});
}

TEST(Hazard, H25_NoticesAreBounded) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const TimePoint begun = world.now();
  const Noticed noticed = run_telling_program(world);
  const double seconds_taken = std::chrono::duration<double>(world.now() - begun).count();
  EXPECT_GT(noticed.triggers.size(), 1U) << world.replay();
  EXPECT_LE(static_cast<double>(noticed.triggers.size()), 10 * seconds_taken + 1) << world.replay();
  EXPECT_LT(noticed.triggers.size(), 50U) << "100 pulses were told within 2 s\n" << world.replay();
}

// The target of a program is unknown, so a caller with a travel envelope cannot run it.
TEST(Hazard, H25_AProgramLeavesNoEnvelope) {
  auto setup = quiet();
  setup.profile.axes[0].travel_maximum = pulses(1000);
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_THAT(execute(world, kProgram), ElementsAre("OUTSIDE_TRAVEL"));
  EXPECT_EQ(written(world, "P:"), 0) << world.replay();
}

}  // namespace
}  // namespace axisgate::simulation
