// Pending restores: each rule of the list, with a case that fails without it. Lines as in manual 89) D:, 94) B:, 96)
// O:, 97) to 101) T:.
#include "device/shrc203/state/pending_restores.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace axisgate::shrc203::pending_restores_test {
namespace {

using Change = PendingRestores::Change;
using Target = Trigger::Target;
using Setting = RestoredSetting;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr AxisSet kOne = AxisSet::of(1), kTwo = AxisSet::of(2);
constexpr SpeedSetting kFirst{1000, 50'000, 100}, kOther{500, 7000, 300}, kThird{200, 2000, 30};
constexpr std::uint64_t kAnna = 1000, kBert = 1001;
constexpr Trigger kNone{}, kByPulses{Target::drive_pulses, 2, 500}, kTimer{Target::timer, 0, 100};
constexpr Trigger kByScale{Target::scale_plus, 1, 2};

constexpr const char* kNothing = "";

void set(State& state, int axis, const SpeedSetting& speed) {
  auto& one = state.axis(axis);
  one.minimum_speed = speed.minimum;
  one.maximum_speed = speed.maximum;
  one.acceleration_ms = speed.acceleration_ms;
}

Change change_of_outputs(int outputs) { return {{}, {}, outputs, {}}; }
Change change_of_trigger(const Trigger& trigger) { return {{}, {}, {}, trigger}; }

// All axes at S 1000 F 50000 R 100, axis 3 not controllable; outputs off, no trigger; the device's first epoch.
class PendingRestoresTest : public testing::Test {
 protected:
  PendingRestoresTest() {
    for (const int axis : {1, 2, 3}) {
      set(state, axis, kFirst);
      state.axis(axis).origin_speeds = kFirst;
      state.axis(axis).controllable = axis != 3;
    }
    state.outputs = 0;
    state.trigger = kNone;
    state.device_epoch = 1;
  }
  std::string line(const PendingRestores& what, RestoredSetting setting) const {
    const auto command = what.command(setting, state);
    return command ? command->line : kNothing;
  }
  // Remembers the previous value and sets the new one, as after the controller's answer.
  void set_outputs(std::uint64_t lease, int outputs) {
    pending.remember(lease, change_of_outputs(outputs), state);
    state.outputs = outputs;
  }
  void set_trigger(std::uint64_t lease, const Trigger& trigger) {
    pending.remember(lease, change_of_trigger(trigger), state);
    state.trigger = trigger;
  }
  void set_speeds(std::uint64_t lease, int axis, const SpeedSetting& speed) {
    pending.remember(lease, {AxisSet::of(axis), {}, {}, {}}, state);
    set(state, axis, speed);
  }

  State state;
  PendingRestores pending;
};

TEST_F(PendingRestoresTest, SpeedsOfAMotionByD) {
  const auto what = PendingRestores::of_motion({{1, kFirst}, {2, kOther}, {3, kFirst}});
  const struct {
    const char* name;
    std::optional<SpeedSetting> one, two, three;  // present speeds; nullopt if unknown
    const char* line;
  } kCases[] = {
      {"as before", kFirst, kOther, kFirst, kNothing},
      {"one is another", kThird, kOther, kFirst, "D:1S1000F50000R100"},
      {"both are others", kThird, kThird, kFirst, "D:AS1000F50000R100 S500F7000R300"},
      {"only S is another", SpeedSetting{999, 50'000, 100}, kOther, kFirst, "D:1S1000F50000R100"},
      {"only F is another", SpeedSetting{1000, 49'999, 100}, kOther, kFirst, "D:1S1000F50000R100"},
      {"only R is another", SpeedSetting{1000, 50'000, 99}, kOther, kFirst, "D:1S1000F50000R100"},
      {"unknown", {}, kOther, kFirst, "D:1S1000F50000R100"},
      {"not controllable", kFirst, kOther, kThird, kNothing},
  };
  for (const auto& one : kCases) {
    int axis = 0;
    for (const auto& now : {one.one, one.two, one.three}) {
      set(state, ++axis, now.value_or(kFirst));
      if (!now) state.axis(axis).maximum_speed.reset();
    }
    EXPECT_EQ(line(what, Setting::speeds), one.line) << one.name;
    EXPECT_EQ(line(what, Setting::origin_speeds), kNothing) << one.name;
  }
}

TEST_F(PendingRestoresTest, SpeedsOfTheOriginReturnByB) {
  pending.remember(kAnna, {{}, kAllAxes, {}, {}}, state);
  const auto what = pending.of_lease(kAnna);
  EXPECT_EQ(line(what, Setting::origin_speeds), kNothing);
  state.axis(2).origin_speeds = kOther;
  EXPECT_EQ(line(what, Setting::origin_speeds), "B:2S1000F50000R100");
  state.axis(1).origin_speeds.reset();
  EXPECT_EQ(line(what, Setting::origin_speeds), "B:AS1000F50000R100 S1000F50000R100");
  state.axis(3).origin_speeds = kOther;
  EXPECT_EQ(line(what, Setting::origin_speeds), "B:AS1000F50000R100 S1000F50000R100") << "axis 3 is not controllable";
  EXPECT_EQ(line(what, Setting::speeds), kNothing);
}

// A value that was unknown before the change is not restored.
TEST_F(PendingRestoresTest, WhatIsUnknownIsNotRemembered) {
  state.axis(1).acceleration_ms.reset();
  state.axis(1).origin_speeds.reset();
  state.outputs.reset();
  state.trigger.reset();
  pending.remember(kAnna, {kOne, kOne, 32, kTimer}, state);
  EXPECT_TRUE(pending.empty());
}

// The value to restore is the first one from before the lease; the lease's own value is the last one that it set.
TEST_F(PendingRestoresTest, TheFirstValueBeforeAndTheLastThatWasSet) {
  state.outputs = 9;
  state.trigger = kByPulses;
  for (const int pattern : {32, 1}) set_outputs(kAnna, pattern);
  for (const Trigger& one : {kByScale, kTimer}) set_trigger(kAnna, one);
  for (const SpeedSetting& speed : {kOther, kThird}) set_speeds(kAnna, 1, speed);
  const auto what = pending.of_lease(kAnna);
  EXPECT_EQ(line(what, Setting::outputs), "O:9");
  EXPECT_EQ(line(what, Setting::trigger), "T:P2P500");
  EXPECT_EQ(line(what, Setting::speeds), "D:1S1000F50000R100");
  state.device_epoch = 2;
  EXPECT_EQ(line(what, Setting::outputs), "O:9") << "1 is what it has set at last";
  state.outputs = 32;
  EXPECT_EQ(line(what, Setting::outputs), kNothing) << "32 no longer is";
}

// After a possible restart, nothing is switched on and no other caller's setting is replaced.
TEST_F(PendingRestoresTest, OutputsByO) {
  const struct {
    const char* name;
    int before, set;
    std::optional<int> now;
    const char *line, *after_restart;
  } kCases[] = {
      {"as before", 9, 32, 9, kNothing, kNothing}, {"as set", 9, 32, 32, "O:9", "O:9"},
      {"off", 9, 32, 0, "O:9", kNothing},          {"switched off", 9, 0, 0, "O:9", kNothing},
      {"another's", 9, 32, 5, "O:9", kNothing},    {"unknown", 9, 32, {}, "O:9", kNothing},
      {"were off", 0, 32, 32, "O:0", "O:0"},
  };
  for (const auto& one : kCases) {
    state.device_epoch = 1;
    state.outputs = one.before;
    PendingRestores list;
    list.remember(kAnna, change_of_outputs(one.set), state);
    state.outputs = one.now;
    const auto what = list.of_lease(kAnna);
    EXPECT_EQ(line(what, Setting::outputs), one.line) << one.name;
    state.device_epoch = 2;
    EXPECT_EQ(line(what, Setting::outputs), one.after_restart) << one.name << ", after a restart";
    list.remember(kAnna, {kOne, {}, {}, {}}, state);
    EXPECT_EQ(line(list.of_lease(kAnna), Setting::outputs), one.line)
        << one.name << ", the lease goes on after the restart";
  }
}

TEST_F(PendingRestoresTest, TheTriggerByT) {
  const struct {
    const char* name;
    Trigger before, set;
    std::optional<Trigger> now;
    const char *line, *after_restart;
    const char* of_scan;
  } kCases[] = {
      {"as before", kTimer, kByPulses, kTimer, kNothing, kNothing, kNothing},
      {"as set", kTimer, kByPulses, kByPulses, "T:T100", "T:T100", "T:T100"},
      {"none", kTimer, kByPulses, kNone, "T:T100", kNothing, kNothing},
      {"switched off", kTimer, kNone, kNone, "T:T100", kNothing, kNothing},
      {"another's", kTimer, kByPulses, kByScale, "T:T100", kNothing, kNothing},
      {"unknown", kTimer, kByPulses, {}, "T:T100", kNothing, kNothing},
      {"was none", kNone, kByPulses, kByPulses, "T:S", "T:S", "T:S"},
      {"was by pulses", kByPulses, kTimer, kTimer, "T:P2P500", "T:P2P500", "T:P2P500"},
      {"was by the scale", kByScale, kTimer, kTimer, "T:E1P+2", "T:E1P+2", "T:E1P+2"},
  };
  for (const auto& one : kCases) {
    state.device_epoch = 1;
    state.trigger = one.before;
    PendingRestores list;
    list.remember(kAnna, change_of_trigger(one.set), state);
    list.remember_scan(one.before, one.set);
    state.trigger = one.now;
    EXPECT_EQ(line(list.of_lease(kAnna), Setting::trigger), one.line) << one.name;
    for (const std::uint64_t epoch : {0, 1, 2}) {
      state.device_epoch = epoch;
      EXPECT_EQ(line(list.of_scan(), Setting::trigger), one.of_scan) << one.name << ", of a scan";
    }
    EXPECT_EQ(line(list.of_lease(kAnna), Setting::trigger), one.after_restart) << one.name << ", after a restart";
  }
}

// A scan's trigger is restored only if it is known to be still armed; a lease's is restored in any case.
TEST_F(PendingRestoresTest, AScansTriggerIsReadFirstWhereItIsUnknown) {
  set_trigger(kAnna, kTimer);
  pending.remember_scan(kNone, kByPulses);
  EXPECT_FALSE(pending.of_scan().must_read_first(Setting::trigger, state));
  state.trigger.reset();
  EXPECT_TRUE(pending.of_scan().must_read_first(Setting::trigger, state));
  EXPECT_FALSE(pending.of_scan().must_read_first(Setting::speeds, state));
  EXPECT_FALSE(pending.of_lease(kAnna).must_read_first(Setting::trigger, state));
}

// The value before the lease is the pending one, not the present one.
TEST_F(PendingRestoresTest, SpeedsThatAMotionHasLeftAreNotTheLeases) {
  pending.keep(PendingRestores::of_motion({{1, kFirst}}));
  set(state, 1, kThird);
  set(state, 2, kThird);
  for (const int axis : {1, 2}) set_speeds(kAnna, axis, kOther);
  EXPECT_EQ(line(pending.of_lease(kAnna), Setting::speeds), "D:AS1000F50000R100 S200F2000R30");
}

// A trigger that a scan has left armed belongs to no lease, as long as it is still the scan's.
TEST_F(PendingRestoresTest, ATriggerThatAScanHasLeftIsNotTheLeases) {
  pending.remember_scan(kTimer, kByPulses);
  state.trigger = kByPulses;
  set_trigger(kAnna, kByScale);
  EXPECT_EQ(line(pending.of_lease(kAnna), Setting::trigger), "T:T100");
  state.trigger = kNone;
  set_trigger(kBert, kByScale);
  EXPECT_EQ(line(pending.of_lease(kBert), Setting::trigger), "T:S");
}

TEST_F(PendingRestoresTest, WhatFailedIsKeptAndTheOldestStays) {
  pending.keep(PendingRestores::of_motion({{1, kFirst}}));
  pending.keep(PendingRestores::of_motion({{1, kOther}, {2, kOther}}));
  const auto what = pending.take(kAllAxes);
  EXPECT_THAT(what.speeds(), ElementsAre(std::pair(1, kFirst), std::pair(2, kOther)));
  pending.remember_scan(kTimer, kByPulses);
  pending.remember_scan(kByPulses, kByScale);
  state.trigger = kByScale;
  EXPECT_EQ(line(pending.of_scan(), Setting::trigger), "T:T100");
}

TEST_F(PendingRestoresTest, AMotionTakesTheSpeedsOfItsAxesOnly) {
  set_speeds(kAnna, 1, kOther);
  pending.keep(PendingRestores::of_motion({{1, kThird}, {2, kThird}}));
  pending.remember_scan(kNone, kTimer);
  EXPECT_THAT(pending.take(kOne).speeds(), ElementsAre(std::pair(1, kThird)));
  EXPECT_TRUE(pending.take(kOne).empty()) << "taken is taken";
  EXPECT_THAT(pending.of_lease(kAnna).speeds(), ElementsAre(std::pair(1, kFirst)));
  EXPECT_TRUE(pending.has_scan());
  EXPECT_THAT(pending.take(kTwo).speeds(), ElementsAre(std::pair(2, kThird)));
}

// A caller's own setting replaces the pending restores of motions and scans; those of leases stay.
TEST_F(PendingRestoresTest, WhatIsForgottenIsTheMotions) {
  pending.remember(kAnna, {kOne, kOne, 32, kTimer}, state);
  pending.keep(PendingRestores::of_motion({{1, kThird}, {2, kThird}}));
  pending.remember_scan(kByPulses, kByScale);
  pending.forget_speeds(kOne);
  pending.forget_scan();
  EXPECT_FALSE(pending.has_scan());
  EXPECT_EQ(pending.take(kAllAxes).sped(), kTwo);
  for (const Setting setting : {Setting::speeds, Setting::origin_speeds, Setting::outputs, Setting::trigger}) {
    set(state, 1, kOther);
    state.axis(1).origin_speeds = kOther;
    state.outputs = 32;
    state.trigger = kTimer;
    EXPECT_NE(line(pending.of_lease(kAnna), setting), kNothing);
  }
  pending.forget_lease(kAnna);
  EXPECT_TRUE(pending.empty());
}

TEST_F(PendingRestoresTest, EachLeaseItsOwn) {
  set_outputs(kBert, 1);
  set_outputs(kAnna, 2);
  pending.remember_scan(kNone, kTimer);
  state.outputs = 63;
  EXPECT_THAT(pending.leases(), ElementsAre(kAnna, kBert));
  EXPECT_EQ(line(pending.of_lease(kBert), Setting::outputs), "O:0");
  EXPECT_EQ(line(pending.of_lease(kAnna), Setting::outputs), "O:1");
  state.device_epoch = 2;
  set_speeds(kBert, 1, kOther);
  state.outputs = 2;
  EXPECT_EQ(line(pending.of_lease(kAnna), Setting::outputs), "O:1");
  state.outputs = 63;
  EXPECT_EQ(line(pending.of_lease(kAnna), Setting::outputs), kNothing) << "the other lease's epoch is not its own";
  const auto all = pending.take_leases();
  EXPECT_THAT(all.leases(), ElementsAre(kAnna, kBert));
  EXPECT_THAT(pending.leases(), IsEmpty());
  EXPECT_TRUE(pending.has_scan()) << "a scan's is no lease's";
  EXPECT_FALSE(all.has_scan());
}

// D:, B: and T: need stationary axes, O: does not.
TEST_F(PendingRestoresTest, TheAxesThatMustBeStationary) {
  const struct {
    Change change;
    AxisSet axes;
  } kCases[] = {
      {{kOne, {}, {}, {}}, kOne},       {{kOne, kTwo, {}, {}}, kOne | kTwo}, {{{}, {}, 32, {}}, {}},
      {{{}, {}, 32, kTimer}, kAllAxes}, {{kOne, {}, 32, {}}, kOne},
  };
  for (const auto& one : kCases) {
    PendingRestores list;
    list.remember(kAnna, one.change, state);
    EXPECT_EQ(list.of_lease(kAnna).stationary_axes(), one.axes);
  }
}

}  // namespace
}  // namespace axisgate::shrc203::pending_restores_test
