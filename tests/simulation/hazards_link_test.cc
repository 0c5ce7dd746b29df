// Hazards of the link: unplugged, another unit, another program on the line. The numbers are those of
// device/shrc203/HAZARDS.md.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;

constexpr const char* kOther = "2106001002";

// Returns the problem that refuses motions now, with its hint.
Problem why_not_up(World& world) {
  const auto up = world.controller().check_up();
  return up ? Problem{} : up.error();
}

bool says_idle(World& world, int axis) { return world.controller().state().axis(axis).busy == false; }

// The cable is unplugged at any instant from before the first line of a move to its middle.
TEST(Hazard, H31_UnpluggedInMidMove) {
  int unknown = 0;
  for (int step = 0; step < 240 && !HasFailure(); ++step) {
    const Duration after = step < 160 ? microseconds(370) * step : milliseconds(60 + 5 * (step - 160));
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    move_by(world, {{1, 150000}});
    world.run_for(after);
    const bool written_go = written(world, "G:") > 0;
    world.wire().cut(world.now(), milliseconds(1500));
    EXPECT_FALSE(says_idle(world, 1)) << after.count() << " ns\n" << world.replay();
    EXPECT_FALSE(world.controller().state().axis(1).position_pulses) << "an old position shown as the new one";
    EXPECT_TRUE(!written_go || world.controller().state().moving_unknown) << after.count() << " ns\n" << world.replay();
    while (world.device().busy(1) && !HasFailure()) {
      EXPECT_FALSE(says_idle(world, 1)) << after.count() << " ns\n" << world.replay();
      EXPECT_TRUE(!written_go || world.controller().state().moving_unknown || world.controller().state().axis(1).busy)
          << after.count() << " ns\n"
          << world.replay();
      world.run_for(milliseconds(10));
    }
    const Motion motion = outcome_of(world, 1);
    EXPECT_EQ(motion.state, written_go ? MotionState::unknown : MotionState::failed) << after.count() << " ns\n"
                                                                                     << world.replay();
    unknown += motion.state == MotionState::unknown ? 1 : 0;
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    EXPECT_FALSE(world.controller().state().moving_unknown);
    EXPECT_TRUE(says_idle(world, 1));
    EXPECT_EQ(world.controller().state().axis(1).position_pulses, world.device().position(1));
    EXPECT_EQ(written(world, "G:"), written_go ? 1 : 0) << "sent again\n" << world.replay();
  }
  EXPECT_GT(unknown, 100);
}

TEST(Hazard, H32_TheConfiguredUnitAndNoOther) {
  auto setup = quiet();
  setup.profile.serial_number = setup.options.serial_number;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  move_by(world, {{1, 500000}});
  world.run_for(seconds(1));
  world.device().set_serial_number(kOther);
  world.power_cycle();
  world.wire().cut(world.now(), seconds(1));
  const std::size_t first = world.wire().commands().size();
  EXPECT_EQ(outcome_of(world, 1).state, MotionState::unknown);
  for (int i = 0; i < 40; ++i) {
    move_by(world, {{1, 100}});
    world.run_for(milliseconds(700));
    ASSERT_NE(world.controller().state().link, LinkState::up) << world.replay();
  }
  EXPECT_THAT(world.controller().state().link_problem, HasSubstr(kOther));
  EXPECT_THAT(world.controller().state().link_problem, HasSubstr(setup.options.serial_number));
  EXPECT_EQ(why_not_up(world).reason, Reason::link_down);
  EXPECT_EQ(why_not_up(world).hint,
            "connect the configured unit again, or correct `serial_number` in the configuration");
  EXPECT_EQ(motion_lines(world, first), 0) << world.replay();
  world.device().set_serial_number(setup.options.serial_number);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.run_for(seconds(6));
  moved(world, {{1, 100}});
}

// Each question of the handshake is asked three times before the connection attempt fails.
TEST(Hazard, H31_AnAnswerOfTheHandshakeMayBeLostTwice) {
  for (const int lost : {2, 3}) {
    World world(quiet());
    int answers = 0;
    world.wire().set_script([&](LineKind kind, const std::string&) -> Scripted {
      const bool asked = kind == LineKind::reply && world.wire().commands().back() == "?:D";
      return {.drop = asked && ++answers <= lost, .delay = {}, .instead = {}};
    });
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    EXPECT_EQ(written(world, "?:FMT"), lost == 2 ? 1 : 2) << world.replay();
  }
}

// Without a configured serial number, the first unit stays the accepted unit until the daemon ends (profile.h).
TEST(Hazard, H32_TheFirstUnitStaysTheOne) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  const std::string first_one = world.controller().state().serial_number;
  world.device().set_serial_number(kOther);
  world.power_cycle();
  world.wire().cut(world.now(), seconds(1));
  for (int i = 0; i < 400; ++i) {
    world.run_for(milliseconds(100));
    ASSERT_NE(world.controller().state().link, LinkState::up) << world.replay();
  }
  EXPECT_THAT(world.controller().state().link_problem, HasSubstr(kOther));
  EXPECT_THAT(world.controller().state().link_problem, HasSubstr(first_one));
  EXPECT_EQ(world.controller().state().serial_number, first_one);
  EXPECT_EQ(why_not_up(world).hint, "connect the former unit again, or restart the daemon to accept this one");
  world.device().set_serial_number(first_one);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_EQ(why_not_up(world).reason, Reason::unspecified);
  moved(world, {{1, 100}});
}

// The unit is swapped beyond a serial server or a hub: the line never goes down, and a barrier or a restart detects the
// swap.
TEST(Hazard, H32_SwappedWithoutAnUnplug) {
  World world(quiet());
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  moved(world, {{1, 700}});
  world.device().set_serial_number(kOther);
  world.power_cycle();
  world.run_for(seconds(10));
  for (int i = 0; i < 40; ++i) {
    world.run_for(milliseconds(700));
    EXPECT_NE(world.controller().state().link, LinkState::up) << world.replay();
  }
  EXPECT_THAT(world.controller().state().link_problem, HasSubstr(kOther));
}

// A digit of the very first identity was changed on the line: the unit is still accepted once its identity is read
// correctly.
TEST(Hazard, H32_AMisreadNumberDoesNotStay) {
  World world(quiet());
  bool turned = false;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (turned || kind != LineKind::reply || !line.starts_with("SIGMAKOKI")) return {};
    turned = true;
    return {.drop = false, .delay = {}, .instead = "SIGMAKOKI,SHRC-203,2106001009,V2.00.000\r\n"};
  });
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  EXPECT_TRUE(turned);
  EXPECT_EQ(world.controller().state().serial_number, "2106001001");
}

// One byte of an identity is damaged, in a barrier or at a connect: the unit is asked again, and stays accepted.
TEST(Hazard, H32_AGarbledIdentityIsNoOtherUnit) {
  for (const bool connects : {false, true}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 700}});
    bool lost = connects, garbled = false;
    int downs = 0;
    world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
      if (kind != LineKind::reply) return {};
      if (!lost && world.wire().commands().back() == "?:V") return {.drop = lost = true, .delay = {}, .instead = {}};
      if (garbled || !line.starts_with("SIGMAKOKI")) return {};
      garbled = true;
      return {.drop = false, .delay = {}, .instead = "SIGMAKOKI,SHRC-203,2106001009,V2.00.000\r\n"};
    });
    world.on_news = [&](const Event& event) {
      const auto* change = std::get_if<LinkChanged>(&event);
      downs += change != nullptr && change->link == LinkState::down ? 1 : 0;
    };
    if (connects) world.wire().cut(world.now(), seconds(1));
    if (!connects) execute(world, {"?:V"});
    ASSERT_TRUE(world.run_until([&] { return garbled; }, seconds(10))) << world.replay();
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    EXPECT_EQ(downs, connects ? 1 : 0) << "the unit was taken for another\n" << world.replay();
  }
}

// Another program also has the line open, and reads the answers to its commands: only ?:CMD detects it.
TEST(Hazard, H33_ForeignTrafficIsAFault) {
  for (const std::string foreign : {"M:1+P500", "PSET:1+P77", "Q:", "C:20"}) {
    World world(quiet());
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    moved(world, {{1, 700}});
    world.run_for(seconds(2));
    const std::uint64_t epoch = world.controller().state().device_epoch;
    world.wire().set_script([](LineKind kind, const std::string&) {
      return Scripted{.drop = kind == LineKind::notice, .delay = {}, .instead = {}};
    });
    world.device().receive(foreign + "\r\n", world.now());
    ASSERT_TRUE(world.run_until([&] { return world.controller().state().link == LinkState::down; }, seconds(2)))
        << foreign << "\n"
        << world.replay();
    EXPECT_THAT(world.controller().state().link_problem, HasSubstr(foreign));
    ASSERT_TRUE(world.run_until_up()) << world.replay();
    EXPECT_GT(world.controller().state().device_epoch, epoch);
    move_by(world, {{2, 100}});
    const Motion motion = outcome_of(world, 2);
    EXPECT_EQ(motion.state, foreign == "C:20" ? MotionState::failed : MotionState::succeeded) << world.replay();
    EXPECT_EQ(world.device().starts(1), 1) << "what the other program had set was started\n" << world.replay();
  }
}

}  // namespace
}  // namespace axisgate::simulation
