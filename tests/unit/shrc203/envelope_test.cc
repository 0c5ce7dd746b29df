#include "device/stage/envelope.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace axisgate::stage::envelope_test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

Quantity millimeters(std::int64_t digits, int decimals = 0) { return {{digits, decimals}, Unit::millimeters}; }
Quantity micrometers(std::int64_t digits) { return {{digits, 0}, Unit::micrometers}; }

// Axis 1, 10 nm a pulse, travels from -5 mm to 5 mm at 2 mm/s at most; for operators up to 3 mm; for token student from
// -1 mm to 2 mm at 0.5 mm/s.
class EnvelopeTest : public testing::Test {
 protected:
  EnvelopeTest() {
    for (const int number : AxisSet::first(3).list()) {
      auto& axis = state.axis(number);
      axis.controllable = true;
      axis.scale = Scale{{10, 0}, false};
    }
    profile.speed_max = 1'000'000;
    AxisProfile& axis = profile.axes[0];
    axis.unit = Unit::millimeters;
    axis.travel_minimum = millimeters(-5);
    axis.travel_maximum = millimeters(5);
    axis.maximum_speed = millimeters(2);
    overrides_for("operator").travel_maximum = millimeters(3);
    LimitOverride& student = overrides_for("token student");
    student.travel_minimum = pulses(-100'000);
    student.travel_maximum = micrometers(2000);
    student.maximum_speed = micrometers(500);
  }

  LimitOverride& overrides_for(const std::string& whose) {
    LimitOverride& limits = profile.axes[0].overrides.emplace_back();
    limits.whose = whose;
    return limits;
  }
  Envelope of(std::string_view who, std::string_view role) const { return {profile, state, who, role}; }
  Envelope admin() const { return of("unix alice", "admin"); }
  Envelope any_operator() const { return of("unix bob", "operator"); }
  Envelope student() const { return of("token student", "operator"); }

  static Reason reason(const Result<void>& checked) { return checked ? Reason::unspecified : checked.error().reason; }
  static std::string message(const Result<void>& checked) { return checked ? "" : checked.error().message; }

  Profile profile;
  State state;
};

TEST_F(EnvelopeTest, EverybodysBoundsAreInclusive) {
  EXPECT_TRUE(admin().check_target(1, 500'000));
  EXPECT_TRUE(admin().check_target(1, -500'000));
  EXPECT_EQ(reason(admin().check_target(1, 500'001)), Reason::outside_travel);
  EXPECT_EQ(reason(admin().check_target(1, -500'001)), Reason::outside_travel);
  EXPECT_EQ(admin().check_target(1, 500'001).error().axis, 1);
  EXPECT_EQ(message(admin().check_target(1, 600'000)), "axis 1 would go to 6mm, beyond its travel maximum of 5mm");
  EXPECT_EQ(message(admin().check_target(1, -600'000)), "axis 1 would go to -6mm, beyond its travel minimum of -5mm");
}

TEST_F(EnvelopeTest, ARoleHasNarrowerBounds) {
  EXPECT_TRUE(any_operator().check_target(1, 300'000));
  EXPECT_TRUE(any_operator().check_target(1, -500'000)) << "everybody's, where theirs says nothing";
  EXPECT_EQ(message(any_operator().check_target(1, 300'001)),
            "axis 1 would go to 3.00001mm, beyond its travel maximum of 3mm for operator");
  EXPECT_EQ(message(any_operator().check_target(1, -600'000)),
            "axis 1 would go to -6mm, beyond its travel minimum of -5mm");
}

// The student is also an operator: the narrowest limit applies, whatever its unit.
TEST_F(EnvelopeTest, ACallerHasTheNarrowestOfHisOwnAndHisRoles) {
  EXPECT_TRUE(student().check_target(1, 200'000));
  EXPECT_TRUE(student().check_target(1, -100'000));
  EXPECT_THAT(message(student().check_target(1, 200'001)),
              EndsWith("beyond its travel maximum of 2mm for token student"));
  EXPECT_THAT(message(student().check_target(1, -100'001)),
              EndsWith("beyond its travel minimum of -1mm for token student"));
  profile.axes[0].overrides[0].travel_maximum = micrometers(1500);
  EXPECT_THAT(message(student().check_target(1, 200'001)), EndsWith("beyond its travel maximum of 1.5mm for operator"));
}

TEST_F(EnvelopeTest, WiderLimitsForSomeChangeNothing) {
  overrides_for("unix alice").travel_maximum = millimeters(9);
  EXPECT_THAT(message(admin().check_target(1, 500'001)), EndsWith("beyond its travel maximum of 5mm"));
}

TEST_F(EnvelopeTest, LimitsWithoutAnyOfEverybodys) {
  profile.axes[0].travel_minimum.reset();
  profile.axes[0].travel_maximum.reset();
  profile.axes[0].maximum_speed.reset();
  EXPECT_TRUE(admin().check_target(1, 999'999'999));
  EXPECT_EQ(reason(admin().check_target(1, 1'000'000'000)), Reason::out_of_range) << "the controller's own";
  EXPECT_EQ(reason(any_operator().check_target(1, 300'001)), Reason::outside_travel);
  EXPECT_EQ(*admin().speed_cap(1), std::nullopt);
  EXPECT_EQ(*student().speed_cap(1), 50'000);
}

TEST_F(EnvelopeTest, TheBoundEitherWay) {
  EXPECT_EQ(admin().bound(1, 1), 500'000);
  EXPECT_EQ(admin().bound(1, -1), -500'000);
  EXPECT_EQ(any_operator().bound(1, 1), 300'000);
  EXPECT_EQ(student().bound(1, 1), 200'000);
  EXPECT_EQ(student().bound(1, -1), -100'000);
  EXPECT_EQ(student().bound(2, 1), 999'999'999) << "as far as the controller counts";
  EXPECT_EQ(student().bound(2, -1), -999'999'999);
}

TEST_F(EnvelopeTest, SpeedsAreCapped) {
  EXPECT_EQ(*admin().speed_cap(1), 200'000);
  EXPECT_EQ(*student().speed_cap(1), 50'000);
  EXPECT_EQ(*admin().speed_cap(2), std::nullopt);
  EXPECT_TRUE(student().check_speed(1, 50'000));
  EXPECT_EQ(reason(student().check_speed(1, 50'001)), Reason::too_fast);
  EXPECT_EQ(message(student().check_speed(1, 60'000)),
            "axis 1 may run at 0.5mm/s at most for token student, not at 0.6mm/s");
  EXPECT_EQ(message(admin().check_speed(1, 300'000)), "axis 1 may run at 2mm/s at most, not at 3mm/s");
}

TEST_F(EnvelopeTest, ASpeedThatIsAskedForIsInPulses) {
  EXPECT_EQ(*student().speed(1, micrometers(500)), 50'000);
  EXPECT_EQ(student().speed(1, micrometers(501)).error().reason, Reason::too_fast);
  EXPECT_EQ(student().speed(1, pulses(0)).error().reason, Reason::out_of_range);
  EXPECT_EQ(student().speed(2, pulses(1'000'001)).error().reason, Reason::out_of_range);
  EXPECT_EQ(student().speed(1, {{5, 0}, Unit::nanometers}).error().reason, Reason::not_representable);
  EXPECT_EQ(student().speed(1, {{1, 0}, Unit::degrees}).error().reason, Reason::unknown_unit);
}

TEST_F(EnvelopeTest, HomeComesFirst) {
  EXPECT_TRUE(student().check_homed(1)) << "not asked for";
  profile.axes[0].require_homing = true;
  EXPECT_EQ(reason(student().check_homed(1)), Reason::not_homed);
  EXPECT_THAT(message(student().check_homed(1)), HasSubstr("axis 1 has not found its origin"));
  EXPECT_THAT(student().check_homed(1).error().hint, HasSubstr("`Home`"));
  EXPECT_TRUE(student().check_homed(2)) << "another axis";
  state.axes[0].homed = true;
  EXPECT_TRUE(student().check_homed(1));
}

TEST_F(EnvelopeTest, HomeComesFirstForSome) {
  profile.axes[0].overrides[1].require_homing = true;
  EXPECT_EQ(reason(student().check_homed(1)), Reason::not_homed);
  EXPECT_TRUE(any_operator().check_homed(1));
  EXPECT_TRUE(admin().check_homed(1));
}

TEST_F(EnvelopeTest, AnAxisThatTurns) {
  profile.axes[1].name = "turn";
  profile.axes[1].unit = Unit::degrees;
  profile.axes[1].travel_maximum = Quantity{{90, 0}, Unit::degrees};
  state.axes[1].scale = Scale{{2500, 0}, true};
  EXPECT_TRUE(admin().check_target(2, 36'000));
  EXPECT_EQ(message(admin().check_target(2, 36'001)),
            "axis 2 (turn) would go to 90.0025deg, beyond its travel maximum of 90deg");
}

// The controller reports 10 nm a pulse, the profile says otherwise.
TEST_F(EnvelopeTest, AnotherStageThanTheProfilesMovesNothing) {
  profile.axes[0].name = "x";
  profile.axes[0].stage = StageProfile{"OSMS20-85", {{1000, 0}, false}, {}};
  EXPECT_EQ(reason(admin().check_axis(1)), Reason::identity_mismatch);
  EXPECT_EQ(reason(admin().check_stage(1)), Reason::identity_mismatch);
  EXPECT_EQ(admin().check_axis(1).error().axis, 1);
  EXPECT_EQ(message(admin().check_axis(1)),
            "a pulse of axis 1 (x) is 10 nm by the controller and 1000 nm by the profile of its stage, OSMS20-85: "
            "another stage is plugged in, the divisions were changed, or the profile is wrong");
  EXPECT_THAT(admin().check_axis(1).error().hint, HasSubstr("`ChangeSettings` with `divisions`"));
  EXPECT_TRUE(admin().check_axis(2)) << "which has no profile";
}

// S: can change the distance of a pulse at any time (manual 55)).
TEST_F(EnvelopeTest, ThePulseIsLookedAtEachTime) {
  profile.axes[0].stage = StageProfile{"OSMS20-85", {{10, 0}, false}, {}};
  EXPECT_TRUE(admin().check_axis(1));
  state.axes[0].scale->per_pulse = {20, 0};
  EXPECT_EQ(reason(admin().check_axis(1)), Reason::identity_mismatch);
  state.axes[0].scale->per_pulse = {10, 0};
  EXPECT_TRUE(admin().check_axis(1));
}

TEST_F(EnvelopeTest, APulseOfAStageThatTurnsIsAnAngle) {
  profile.axes[1].unit = Unit::pulses;
  profile.axes[1].stage = StageProfile{"OSMS-60YAW", {{2500, 0}, true}, Decimal{360, 0}};
  state.axes[1].scale = Scale{{5000, 0}, profile.axes[1].rotary()};
  EXPECT_THAT(message(admin().check_axis(2)),
              HasSubstr("is 0.005 deg by the controller and 0.0025 deg by the profile of its stage, OSMS-60YAW"));
  state.axes[1].scale->per_pulse = {2500, 0};
  EXPECT_TRUE(admin().check_axis(2));
}

TEST_F(EnvelopeTest, ALimitThatIsNoWholePulsesIsToldAsThat) {
  profile.axes[0].travel_maximum = Quantity{{15, 0}, Unit::nanometers};
  profile.axes[0].maximum_speed = Quantity{{15, 0}, Unit::nanometers};
  EXPECT_EQ(reason(admin().check_target(1, 0)), Reason::not_representable);
  EXPECT_EQ(
      message(admin().check_target(1, 0)),
      "axis 1 cannot be kept to its travel_maximum: \"15nm\" is not a whole number of pulses of 10 nm; the nearest "
      "are 10nm and 20nm");
  EXPECT_EQ(message(admin().check_speed(1, 1)),
            "axis 1 cannot be kept to its maximum_speed: \"15nm/s\" is not a whole number of pulses of 10 nm a second; "
            "the nearest are 10nm/s and 20nm/s");
}

TEST_F(EnvelopeTest, AxesOfWhichNothingCanBeSaid) {
  EXPECT_TRUE(admin().check_axis(3));
  EXPECT_EQ(reason(admin().check_axis(0)), Reason::unknown_axis);
  EXPECT_EQ(reason(admin().check_axis(4)), Reason::unknown_axis);
  state.axes[1].controllable = false;
  EXPECT_EQ(reason(admin().check_axis(2)), Reason::unknown_axis);
  state.axes[2].scale.reset();
  EXPECT_EQ(reason(admin().check_axis(3)), Reason::position_unknown);
  state = {};
  EXPECT_EQ(reason(admin().check_axis(1)), Reason::link_down);
}

}  // namespace
}  // namespace axisgate::stage::envelope_test
