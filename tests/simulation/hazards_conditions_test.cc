// Tests that a change by a person at the stage is recorded within one idle poll: emergency button, limit sensors,
// motors, mode. Hazard 61.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::ElementsAre;
using testing::IsEmpty;

// One question of the poll during a motion, and four exchanges at 38400 baud.
constexpr Duration kExchanges = milliseconds(200);

struct StageRecord : EventSink {
  struct Entry {
    std::string text;
    ConditionChanged change;
    TimePoint told;
  };
  void on_event(const Event& event, TimePoint now) override {
    const auto* change = std::get_if<ConditionChanged>(&event);
    if (change == nullptr) return;
    entries.push_back({stage::words(change->condition, change->axes, change->begun, change->value), *change, now});
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> all;
    for (const Entry& entry : entries) all.push_back(entry.text);
    return all;
  }
  std::vector<Entry> entries;
};

class Hazard61 : public testing::TestWithParam<bool> {
 protected:
  Hazard61() {
    auto setup = quiet();
    setup.listener = &record_;
    setup.followed = GetParam();
    world_ = std::make_unique<World>(setup);
    EXPECT_TRUE(world_->run_until_up()) << world_->replay();
    world_->run_for(milliseconds(2345));
  }

  // Runs `deed` and expects its entries in the record: in time, and between two readings before and after it.
  void expect(const std::function<void()>& deed, const std::vector<std::string>& texts) {
    record_.entries.clear();
    const TimePoint begun = world_->now();
    deed();
    const TimePoint done = world_->now();
    const Duration limit = world_->controller().profile().idle_poll + kExchanges;
    world_->run_until([&] { return record_.entries.size() >= texts.size(); }, limit);
    EXPECT_THAT(record_.texts(), testing::UnorderedElementsAreArray(texts)) << world_->replay();
    for (const StageRecord::Entry& entry : record_.entries) {
      EXPECT_LE(entry.change.before, done) << entry.text;
      EXPECT_GE(entry.change.seen, begun) << entry.text;
      EXPECT_LE(entry.change.seen, entry.told) << entry.text;
      EXPECT_GT(entry.change.before, TimePoint{}) << entry.text;
    }
    world_->run_for(seconds(3));
    EXPECT_EQ(record_.entries.size(), texts.size()) << "told twice\n" << world_->replay();
  }

  simulator::Simulator& device() { return world_->device(); }
  TimePoint now() const { return world_->now(); }
  void move_long() {
    move_by(*world_, {{1, 1'500'000}});
    world_->run_for(milliseconds(1234));
    ASSERT_TRUE(device().busy(1)) << world_->replay();
  }

  StageRecord record_;
  std::unique_ptr<World> world_;
};

TEST_P(Hazard61, TheButtonAtRest) {
  // The button also switches the motors off (manual 66)), which the next question reads.
  expect([&] { device().press_emergency(now()); }, {"axes 1, 2 and 3: emergency stop", "axes 1, 2 and 3: motor off"});
  expect([&] { execute(*world_, {"BEC:W"}); }, {"axes 1, 2 and 3: emergency stop ended"});
  expect([&] { execute(*world_, {"C:W1"}); }, {"axes 1, 2 and 3: motor on"});
}

TEST_P(Hazard61, TheButtonInMotion) {
  move_long();
  expect([&] { device().press_emergency(now()); }, {"axes 1, 2 and 3: emergency stop", "axes 1, 2 and 3: motor off"});
  EXPECT_EQ(reason_of(outcome_of(*world_, 1)), Reason::emergency_stopped) << world_->replay();
}

TEST_P(Hazard61, ALimitSensor) {
  expect([&] { device().set_limit(2, -1, true, now()); }, {"axis 2: CCW limit sensor on"});
  expect([&] { device().set_limit(2, -1, false, now()); }, {"axis 2: CCW limit sensor off"});
  move_long();
  expect([&] { device().set_limit(2, 1, true, now()); }, {"axis 2: CW limit sensor on"});
  EXPECT_TRUE(device().busy(1)) << "none of its business";
}

TEST_P(Hazard61, AMotor) {
  expect([&] { device().set_excitation(3, false, now()); }, {"axis 3: motor off"});
  expect([&] { device().set_excitation(3, true, now()); }, {"axis 3: motor on"});
  move_long();
  expect([&] { device().set_excitation(3, false, now()); }, {"axis 3: motor off"});
  EXPECT_TRUE(device().busy(1));
  expect([&] { device().set_excitation(1, false, now()); }, {"axis 1: motor off"});
  EXPECT_EQ(reason_of(outcome_of(*world_, 1)), Reason::not_excited) << world_->replay();
}

TEST_P(Hazard61, TheMode) {
  expect([&] { device().set_mode("MANUAL", now()); }, {"controller in MANUAL mode"});
  world_->run_for(seconds(60));
  const TimePoint back = now();
  device().set_mode("HOST", back);
  ASSERT_TRUE(world_->run_until_up()) << world_->replay();
  ASSERT_THAT(record_.texts(), ElementsAre("controller in MANUAL mode", "controller in HOST mode again"));
  EXPECT_LE(record_.entries[1].change.before, back);
  EXPECT_GE(record_.entries[1].change.seen, back);
  EXPECT_LE(record_.entries[1].change.seen - record_.entries[1].change.before, seconds(1) + kExchanges);
  move_long();
  expect([&] { device().set_mode("TEACHING", now()); }, {"controller in TEACHING mode"});
}

TEST_P(Hazard61, AnErrorWithoutABit) {
  expect([&] { device().set_error(2, simulator::AxisError::s9, true, now()); }, {"axis 2: error without a name"});
  expect([&] { device().set_error(2, simulator::AxisError::scale, true, now()); },
         {"axis 2: error without a name ended", "axis 2: scale error (S1)"});
}

// Moves and a homing change the status, but no person at the panel causes that.
TEST_P(Hazard61, WhatIsAskedHereIsNone) {
  home(*world_, kAllAxes);
  EXPECT_EQ(outcome_of(*world_, 1).state, MotionState::succeeded) << world_->replay();
  moved(*world_, {{1, 1000}, {2, -2000}});
  execute(*world_, {"P:R", "P:H"});
  world_->run_for(seconds(5));
  EXPECT_THAT(record_.texts(), IsEmpty()) << world_->replay();
}

INSTANTIATE_TEST_SUITE_P(Followed, Hazard61, testing::Bool());

// For an event during a loss of the line, the earlier time is that of the last reading before the loss.
TEST(Hazard, H61_WhatHappensWhileTheLineIsLost) {
  StageRecord record;
  auto setup = quiet();
  setup.listener = &record;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.run_for(seconds(5));
  const TimePoint lost = world.now();
  world.wire().cut(lost, seconds(20));
  world.run_for(seconds(10));
  world.device().press_emergency(world.now());
  ASSERT_TRUE(world.run_until([&] { return record.entries.size() == 2; }, seconds(30))) << world.replay();
  EXPECT_THAT(record.texts(),
              testing::UnorderedElementsAre("axes 1, 2 and 3: emergency stop", "axes 1, 2 and 3: motor off"));
  EXPECT_LE(record.entries[0].change.before, lost);
  EXPECT_GE(record.entries[0].change.before, lost - seconds(2));
  EXPECT_GE(record.entries[0].change.seen, lost + seconds(20));
}

// One of many statuses arrives with a wrong digit: 0x20 and 0x80001 instead of 1.
TEST(Hazard, H61_AFlippedBitIsNoEvent) {
  StageRecord record;
  auto setup = quiet();
  setup.listener = &record;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  int positions = 0, motors = 0;
  world.wire().set_script([&](LineKind kind, const std::string& line) -> Scripted {
    if (kind != LineKind::reply) return {};
    if (line == "1,1,1" && ++motors % 3 == 0) return {.drop = false, .delay = {}, .instead = "0,1,1\r\n"};
    const auto status = line.find(",1,1,1,");
    if (status == line.npos || ++positions % 3 != 0) return {};
    std::string other = line;
    other.replace(status + 1, 1, positions % 2 ? "20" : "80001");
    return {.drop = false, .delay = {}, .instead = other + "\r\n"};
  });
  world.run_for(seconds(30));
  move_by(world, {{1, 500'000}});
  world.run_for(seconds(8));
  EXPECT_GT(std::min(positions, motors), 30);
  EXPECT_THAT(record.texts(), IsEmpty()) << world.replay();
}

// With one axis alone, the answer to ?:C may look like its completion. The question delays no motion.
TEST(Hazard, H61_AControllerWithOneAxis) {
  StageRecord record;
  auto setup = quiet();
  setup.listener = &record;
  setup.options.axis_setting = 0;
  World world(setup);
  ASSERT_TRUE(world.run_until_up()) << world.replay();
  world.run_for(seconds(3));
  world.device().set_excitation(1, false, world.now());
  ASSERT_TRUE(world.run_until([&] { return !record.entries.empty(); }, seconds(1) + kExchanges)) << world.replay();
  EXPECT_THAT(record.texts(), ElementsAre("axis 1: motor off"));
}

}  // namespace
}  // namespace axisgate::simulation
