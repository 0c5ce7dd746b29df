// Positions to which lines would lead according to the manual, and the envelope's checks of them.
#include "device/shrc203/planning/transaction_prediction.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203::transaction_prediction_test {
namespace {

using testing::ElementsAre;
using Lines = std::vector<std::string>;
constexpr auto kUnknown = std::nullopt;

// A pulse is 10 nm. The axes are at 1000, 2000 and 3000 pulses, travel from -5 mm to 5 mm (500,000 pulses) at 2 mm/s
// (200,000 pulses/s) at most, and are set to S100F1000.
class ForecastTest : public testing::Test {
 protected:
  ForecastTest() {
    for (std::size_t i = 0; i < 3; ++i) {
      state.axes[i].controllable = true;
      state.axes[i].scale = Scale{{10, 0}, false};
      profile.axes[i].travel_minimum = Quantity{{-5, 0}, Unit::millimeters};
      profile.axes[i].travel_maximum = Quantity{{5, 0}, Unit::millimeters};
      profile.axes[i].maximum_speed = Quantity{{2, 0}, Unit::millimeters};
    }
  }

  struct Outcome {
    Result<void> result;
    Positions at;
    std::size_t taken = 0;  // lines accepted before the refused one
  };
  Outcome forecast(const Lines& lines) const {
    const Envelope envelope(profile, state, "unix alice", "operator");
    TransactionPrediction forecast(envelope, start, speeds, state.controllable());
    Outcome outcome;
    for (const auto& line : lines) {
      const auto command = model().parse(line);
      if (!command) ADD_FAILURE() << line << ": " << command.error().message;
      outcome.result = command ? forecast.add(*command) : Result<void>();
      outcome.at = forecast.at();
      if (!outcome.result) break;
      ++outcome.taken;
    }
    return outcome;
  }
  Positions ends(const Lines& lines) const {
    const Outcome outcome = forecast(lines);
    EXPECT_TRUE(outcome.result) << outcome.result.error().message;
    return outcome.at;
  }
  // Returns the reason for which the last line, and no earlier one, is refused, with the axis if there is one:
  // "TOO_FAST 1".
  std::string refusal(const Lines& lines) const {
    const Outcome outcome = forecast(lines);
    if (outcome.result) return "none";
    EXPECT_EQ(outcome.taken + 1, lines.size()) << outcome.result.error().message;
    const Problem& problem = outcome.result.error();
    return std::string(name(problem.reason)) + (problem.axis ? " " + std::to_string(*problem.axis) : "");
  }

  Profile profile;
  State state;
  Positions start{1000, 2000, 3000};
  std::map<int, SpeedSetting> speeds{{1, {100, 1000, 100}}, {2, {100, 1000, 100}}, {3, {100, 1000, 100}}};
};

TEST_F(ForecastTest, WhatIsSetMovesOnceItIsStarted) {
  EXPECT_THAT(ends({"M:1+P1000"}), ElementsAre(1000, 2000, 3000));
  EXPECT_THAT(ends({"M:1+P1000", "G:1"}), ElementsAre(2000, 2000, 3000));
  EXPECT_THAT(ends({"M:A+P1000-P500", "G:1"}), ElementsAre(2000, 2000, 3000));
  EXPECT_THAT(ends({"M:A+P1000-P500", "G:A"}), ElementsAre(2000, 1500, 3000));
  EXPECT_THAT(ends({"M:W+P1+P2-P3", "G"}), ElementsAre(1001, 2002, 2997)) << "manual 85): all axes";
  EXPECT_THAT(ends({"M:C+P1+P2", "G:"}), ElementsAre(1000, 2001, 3002)) << "manual 86): all axes";
  EXPECT_THAT(ends({"MP:B+P10-P20", "G:B"}), ElementsAre(1010, 2000, 2980));
  EXPECT_THAT(ends({"M:1+P1000", "G:1", "G:1"}), ElementsAre(2000, 2000, 3000)) << "nothing is left";
}

TEST_F(ForecastTest, TargetsAreCoordinates) {
  EXPECT_THAT(ends({"A:1+P500", "G:1"}), ElementsAre(500, 2000, 3000));
  EXPECT_THAT(ends({"A:B+P10-P20", "G:B"}), ElementsAre(10, 2000, -20));
  EXPECT_THAT(ends({"AP:2-P7", "G:2"}), ElementsAre(1000, -7, 3000));
}

TEST_F(ForecastTest, WaysHaveUnits) {
  EXPECT_THAT(ends({"M:W+U10+N50-M0.5", "G:W"}), ElementsAre(2000, 2005, -47'000));
  EXPECT_THAT(ends({"A:1+M1", "G:1"}), ElementsAre(100'000, 2000, 3000));
  EXPECT_EQ(refusal({"M:1+N5"}), "NOT_REPRESENTABLE 1") << "half a pulse";
  EXPECT_EQ(refusal({"M:1+D1"}), "UNKNOWN_UNIT 1");
}

TEST_F(ForecastTest, StraightLines) {
  EXPECT_THAT(ends({"K:A+P100-P200", "G:A"}), ElementsAre(1100, 1800, 3000));
  EXPECT_THAT(ends({"KP:D+P1+P2+P3", "G:D"}), ElementsAre(1001, 2002, 3003));
  EXPECT_THAT(ends({"KP:C+U1+P2,S100F1000R200", "G:C"}), ElementsAre(1000, 2100, 3002));
}

// Relative to the circle's center, the axes start at (-100, 200); a quarter turn clockwise ends at (200, 100).
TEST_F(ForecastTest, CurvesEndWhereTheirGeometrySays) {
  EXPECT_THAT(ends({"E:0A0+P100-P200", "G:A"}), ElementsAre(1000, 2000, 3000)) << "a whole circle";
  EXPECT_THAT(ends({"E:1B0+P100-P200D90", "G:B"}), ElementsAre(1300, 2000, 2900)) << "the manual's own, 72)";
  EXPECT_THAT(ends({"E:2A0+P100+P100+P200+P0", "G:A"}), ElementsAre(1200, 2000, 3000));
  EXPECT_THAT(ends({"E:3A1N2+P100+P0+P50", "G:D"}), ElementsAre(1000, 2000, 3100)) << "50 each turn";
  EXPECT_THAT(ends({"E:4A0+P100-P200D90+P40", "G:D"}), ElementsAre(1300, 1900, 3040)) << "40 in all";
  EXPECT_THAT(ends({"E:5A0+P100+P100+P200+P0-P30", "G:D"}), ElementsAre(1200, 2000, 2970));
  EXPECT_THAT(ends({"EP:1C0+P100-P200D90,S100F1000R100", "G:C"}), ElementsAre(1000, 2300, 2900));
}

TEST_F(ForecastTest, OneMotionBeginsWhereTheOneBeforeEnded) {
  EXPECT_THAT(ends({"M:1+P10", "G:1", "M:1+P20", "G:1"}), ElementsAre(1030, 2000, 3000));
  EXPECT_THAT(ends({"A:1+P0", "G:1", "K:A+P5+P5", "G:A"}), ElementsAre(5, 2005, 3000));
  EXPECT_THAT(ends({"HRT:1", "M:1+P10", "G:1"}), ElementsAre(10, 2000, 3000));
  EXPECT_THAT(ends({"MP:1+P10", "G:1", "MP:1+P20", "G:1"}), ElementsAre(1030, 2000, 3000)) << "a chain";
}

// Manual 2. 2): "Write in Overwrite"; 87): GC: deletes the settings of M:, A:, E: and K:.
TEST_F(ForecastTest, ASettingIsSetAnewOrDeleted) {
  EXPECT_THAT(ends({"M:1+P1000", "M:1+P5", "G:1"}), ElementsAre(1005, 2000, 3000));
  EXPECT_THAT(ends({"MP:1+P1000", "MP:1+P5", "G:1"}), ElementsAre(1005, 2000, 3000));
  EXPECT_THAT(ends({"K:A+P1+P2", "K:A+P3+P4", "G:A"}), ElementsAre(1003, 2004, 3000));
  for (const std::string set : {"M:A+P10+P20", "A:A+P10+P20", "K:A+P10+P20", "E:0A0+P100+P0"}) {
    EXPECT_THAT(ends({set, "GC:", "G:"}), ElementsAre(1000, 2000, 3000)) << set;
  }
  EXPECT_THAT(ends({"M:A+P10+P20", "GC:1", "G:A"}), ElementsAre(1000, 2020, 3000));
  EXPECT_THAT(ends({"MP:1+P10", "GC:1", "G:1"}), ElementsAre(1010, 2000, 3000));
  EXPECT_THAT(ends({"AP:1+P10", "GC:1", "G:1"}), ElementsAre(10, 2000, 3000));
  EXPECT_THAT(ends({"KP:A+P10+P20", "GC:A", "G:A"}), ElementsAre(1010, 2020, 3000));
  EXPECT_THAT(ends({"EP:1B0+P100-P200D90", "GC:B", "G:B"}), ElementsAre(1300, 2000, 2900));
}

// Each letter has one setting (manual 22) to 25) ?:E to ?:KP), whatever its axes: "Write in Overwrite" (2. 2)).
TEST_F(ForecastTest, ALineOrCurveSetAnewIsGoneOnAllItsAxes) {
  EXPECT_THAT(ends({"K:A+P100+P100", "K:B+P7+P7", "G"}), ElementsAre(1007, 2000, 3007));
  EXPECT_THAT(ends({"KP:A+P100+P100", "KP:C+P7+P7", "G"}), ElementsAre(1000, 2007, 3007));
  EXPECT_THAT(ends({"K:D+P1+P2+P3", "K:A+P4+P5", "G", "M:3+P1", "G:3"}), ElementsAre(1004, 2005, 3001));
  EXPECT_THAT(ends({"E:1A0+P100-P200D90", "E:1C0+P100-P200D90", "G"}), ElementsAre(1000, 2300, 2900));
  EXPECT_THAT(ends({"EP:3A1N1+P100+P0+P50", "EP:0A0+P100+P0", "G"}), ElementsAre(1000, 2000, 3000));
  EXPECT_EQ(refusal({"K:A+P100-P300000", "K:B+P50+P50", "G:D", "MP:2+P700000"}), "OUTSIDE_TRAVEL 2");
  EXPECT_EQ(refusal({"M:2+P1", "G:2", "KP:A+P1+P1", "KP:B+P1+P1"}), "INVALID_REQUEST 2") << "which may have begun";
}

// Manual 87) does not say whether GC: for some axes of a line deletes the line.
TEST_F(ForecastTest, ALineDeletedInPartLeavesOpenWhereItsAxesEnd) {
  EXPECT_THAT(ends({"K:A+P1+P2", "GC:1", "M:3+P1", "G"}), ElementsAre(kUnknown, kUnknown, 3001));
  EXPECT_EQ(refusal({"K:A+P1+P300000", "GC:2", "MP:2+P300000", "G"}), "OUTSIDE_TRAVEL 2") << "where both run";
  EXPECT_THAT(ends({"KP:A+P1+P2", "GC:1", "G"}), ElementsAre(1001, 2002, 3000)) << "GC: does not name KP:";
  EXPECT_THAT(ends({"K:A+P1+P2", "GC:3", "G"}), ElementsAre(1001, 2002, 3000)) << "none of its axes";
}

// The manual does not say which of the two settings the controller starts, or whether it starts both (86)).
TEST_F(ForecastTest, WhereSeveralSettingsWaitTheEndIsNotKnown) {
  EXPECT_THAT(ends({"M:1+P10", "A:1+P20", "G:1"}), ElementsAre(kUnknown, 2000, 3000));
  EXPECT_THAT(ends({"M:1+P10", "MP:1+P20", "G:1"}), ElementsAre(kUnknown, 2000, 3000));
  EXPECT_THAT(ends({"A:1+P10", "KP:A+P1+P2", "G:A"}), ElementsAre(kUnknown, 2002, 3000));
  // The setting of two axes may or may not have run, so both ends are unknown.
  EXPECT_THAT(ends({"K:A+P10+P20", "M:1+P5", "G:A"}), ElementsAre(kUnknown, kUnknown, 3000));
  EXPECT_THAT(ends({"E:0C0+P10+P20", "A:3+P5", "G:"}), ElementsAre(1000, kUnknown, kUnknown));
  EXPECT_EQ(refusal({"M:1+P10", "A:1+P20", "G:1", "M:1+P1"}), "POSITION_UNKNOWN 1");
  EXPECT_THAT(ends({"M:1+P10", "A:1+P20", "G:1", "A:1+P1", "G:1"}), ElementsAre(1, 2000, 3000)) << "is again";
  EXPECT_THAT(ends({"K:A+P1+P2", "M:1+P5", "G:A", "A:1+P1", "G:1"}), ElementsAre(1, kUnknown, 3000)) << "of a line";
  EXPECT_THAT(ends({"K:A+P1+P2", "M:1+P5", "G:1", "A:1+P1", "G:1"}), ElementsAre(kUnknown, 2000, 3000)) << "not run";
}

TEST_F(ForecastTest, OriginReturnsEndAtZero) {
  EXPECT_THAT(ends({"H:1"}), ElementsAre(0, 2000, 3000));
  EXPECT_THAT(ends({"H:W"}), ElementsAre(0, 0, 0));
  EXPECT_THAT(ends({"HRT:B"}), ElementsAre(0, 2000, 0));
  EXPECT_THAT(ends({"Z:2"}), ElementsAre(1000, 0, 3000));
  EXPECT_THAT(ends({"ZRT:"}), ElementsAre(0, 0, 0));
  EXPECT_THAT(ends({"MP:1+P10", "HRT:1"}), ElementsAre(10, 2000, 3000)) << "the prebuffer follows";
  start = {};
  EXPECT_THAT(ends({"HRT:1"}), ElementsAre(0, kUnknown, kUnknown));
}

// Manual 47): a sleeping axis returns to "the position before sleep"; 2. 3): the prebuffer's setting starts when a wait
// ends.
TEST_F(ForecastTest, WaitsAndSleepMoveNothingThemselves) {
  EXPECT_THAT(ends({"SLEEP:1", "SLEEP:0"}), ElementsAre(1000, 2000, 3000));
  EXPECT_THAT(ends({"MP:1+P10", "SLEEP:1"}), ElementsAre(1000, 2000, 3000));
  EXPECT_THAT(ends({"MP:1+P10", "WT:1,5"}), ElementsAre(1000, 2000, 3000));
  EXPECT_THAT(ends({"MP:1+P10", "WT:1,5", "G:1"}), ElementsAre(1010, 2000, 3000));
  EXPECT_THAT(ends({"MP:1+P10", "WI:1,3", "G:1"}), ElementsAre(1010, 2000, 3000));
  EXPECT_THAT(ends({"MP:1+P10", "WT:1,0"}), ElementsAre(1010, 2000, 3000)) << "cancelled";
  EXPECT_THAT(ends({"MP:1+P10", "WI:1,C"}), ElementsAre(1010, 2000, 3000));
}

TEST_F(ForecastTest, WhatMovesNothingLeadsNowhere) {
  EXPECT_THAT(ends({"?:V", "Q:SPC", "O:1", "C:11", "BEEP:1", "W:5", "DR:1 100", "P:R", "P:ON", "MS:ON", "MODE:HOST"}),
              ElementsAre(1000, 2000, 3000));
}

TEST_F(ForecastTest, EveryEndLiesWithinTheTravelInclusively) {
  EXPECT_THAT(ends({"M:1+P499000", "G:1"}), ElementsAre(500'000, 2000, 3000));
  EXPECT_EQ(refusal({"M:1+P499001"}), "OUTSIDE_TRAVEL 1");
  EXPECT_EQ(refusal({"M:1-P501001"}), "OUTSIDE_TRAVEL 1");
  EXPECT_EQ(refusal({"A:A+P0+P500001"}), "OUTSIDE_TRAVEL 2");
  EXPECT_EQ(refusal({"MP:3+M5"}), "OUTSIDE_TRAVEL 3");
  EXPECT_EQ(refusal({"AP:1-P500001"}), "OUTSIDE_TRAVEL 1");
  EXPECT_EQ(refusal({"K:A+P1+P498001"}), "OUTSIDE_TRAVEL 2");
  EXPECT_EQ(refusal({"KP:B+P1-P503001"}), "OUTSIDE_TRAVEL 3");
  EXPECT_EQ(refusal({"E:2A1+P100+P250000+P0+P499000"}), "OUTSIDE_TRAVEL 2");
  EXPECT_EQ(refusal({"E:3A0N2+P100+P0+P250000"}), "OUTSIDE_TRAVEL 3");
}

// A typed line must end within the travel, like a typed move; a curve must be within it throughout.
TEST_F(ForecastTest, AWayBackMayBeginOutside) {
  start[0] = 600'000;
  for (const std::string line : {"M:1-P200000", "MP:1-P200000", "A:1+P400000", "K:A-P200000+P0", "KP:A-P200000+P0"}) {
    EXPECT_THAT(ends({line, "G"}), ElementsAre(400'000, 2000, 3000)) << line;
  }
  EXPECT_EQ(refusal({"M:1-P99999"}), "OUTSIDE_TRAVEL 1") << "nearer, and not inside";
  EXPECT_EQ(refusal({"E:1A0-P200000+P0D180"}), "OUTSIDE_TRAVEL 1");
}

TEST_F(ForecastTest, FromWhereTheMotionsBeforeHaveLed) {
  EXPECT_EQ(refusal({"M:1+P300000", "G:1", "M:1+P300000"}), "OUTSIDE_TRAVEL 1");
  EXPECT_EQ(refusal({"A:2+P400000", "G:2", "K:A+P1+P100001"}), "OUTSIDE_TRAVEL 2");
  // The setting was allowed when it was set, but not from where it starts.
  EXPECT_EQ(refusal({"M:1+P300000", "MP:1+P300000", "G:1"}), "OUTSIDE_TRAVEL 1");
  EXPECT_EQ(refusal({"AP:1+P400000", "E:0A0+P100000+P0", "G:A"}), "OUTSIDE_TRAVEL 1");
}

// A circle ends where it began, but extends by its diameter in between.
TEST_F(ForecastTest, AllOfACurveLiesWithinTheTravel) {
  EXPECT_THAT(ends({"E:0A0+P249500+P0", "G:A"}), ElementsAre(1000, 2000, 3000));
  EXPECT_EQ(refusal({"E:0A0+P249501+P0"}), "OUTSIDE_TRAVEL 1");
  EXPECT_EQ(refusal({"EP:0B1+P0-P251501"}), "OUTSIDE_TRAVEL 3");
  // Clockwise, the arc leads from left to right over the top; the other direction would lead below (manual 73)).
  profile.axes[1].travel_minimum = pulses(1950);
  EXPECT_THAT(ends({"E:2A0+P100+P100+P200+P0", "G:A"}), ElementsAre(1200, 2000, 3000));
  EXPECT_EQ(refusal({"E:2A1+P100+P100+P200+P0"}), "OUTSIDE_TRAVEL 2");
}

TEST_F(ForecastTest, EverySpeedThatIsSetIsHeldAgainstTheCap) {
  for (const std::string line :
       {"D:1S100F200001R100", "D:1S200001F200001R100", "DS:1F200001", "DF:1F200001", "DF:1M3", "B:1S100F200001R100",
        "JD:1F200001", "MP:1+P1,S100F200001R100", "AP:1+P1,S100F200001R100", "KP:A+P1+P1,S100F200001R100",
        "EP:0A0+P100+P0,S100F200001R100"}) {
    EXPECT_EQ(refusal({line}), "TOO_FAST 1") << line;
  }
  EXPECT_EQ(refusal({"D:AS100F1000R100 S100F200001R100"}), "TOO_FAST 2");
  EXPECT_EQ(refusal({"DF:1D3"}), "UNKNOWN_UNIT 1");
  ends({"D:1S200000F200000R100", "DF:1M2", "B:1S100F200000R100", "MP:1+M1,S1F2R100"});
}

TEST_F(ForecastTest, AMotionRunsAtTheSpeedThatIsSet) {
  speeds[1].maximum = 200'001;
  for (const std::string line : {"M:1+P1", "A:1+P1", "MP:1+P1", "AP:1+P1", "Z:1", "ZRT:1"}) {
    EXPECT_EQ(refusal({line}), "TOO_FAST 1") << line;
  }
  ends({"M:2+P1", "G:2", "H:1"});
  ends({"D:1S100F1000R100", "M:1+P1"});
  ends({"DF:1F1000", "M:1+P1"});
  ends({"MP:1+P1,S100F1000R100", "G:1", "M:1+P1", "G:1"});
  EXPECT_EQ(refusal({"B:1S100F1000R100", "M:1+P1"}), "TOO_FAST 1") << "which is of the origin return";
  EXPECT_EQ(refusal({"DS:1F100", "M:1+P1"}), "TOO_FAST 1");
}

// Manual 83): "at the minimum speed of the D: command ... for the axis with the smallest axis number".
TEST_F(ForecastTest, ALineRunsAtTheLowestSpeedOfItsLowerAxis) {
  speeds[1].maximum = speeds[2].maximum = speeds[2].minimum = 300'000;
  ends({"K:A+P1+P1", "G:A", "KP:B+P1+P1", "G:B", "E:0A0+P100+P0", "G:A"});
  for (const std::string line : {"K:C+P1+P1", "KP:C+P1+P1", "E:0C0+P100+P0", "EP:0C0+P100+P0"}) {
    EXPECT_EQ(refusal({line}), "TOO_FAST 2") << line;
  }
  speeds[1].minimum = 150'000;
  profile.axes[1].maximum_speed = pulses(100'000);
  EXPECT_EQ(refusal({"K:A+P1+P1"}), "TOO_FAST 2") << "the other axis has its own cap";
  EXPECT_EQ(refusal({"E:0A0+P100+P0"}), "TOO_FAST 2");
  ends({"KP:A+P1+P1,S100F1000R200", "G:A"});
}

// S may have changed between the setting and the start.
TEST_F(ForecastTest, ALineRunsAtTheSpeedOfItsStart) {
  profile.axes[1].maximum_speed = pulses(100'000);
  EXPECT_EQ(refusal({"K:A+P1+P1", "D:1S150000F150000R100", "G:A"}), "TOO_FAST 2");
  EXPECT_EQ(refusal({"E:0A0+P100+P0", "DS:1F150000", "G:A"}), "TOO_FAST 2");
  ends({"K:A+P1+P1", "D:1S100000F150000R100", "G:A"});
}

// 6283 pulses around, and 1000 or 6283 along: 0.16 or 0.71 of the speed.
TEST_F(ForecastTest, TheAxisOfAHelixMakesItsShareOfTheSpeed) {
  speeds[1].minimum = 100'000;
  profile.axes[2].maximum_speed = pulses(50'000);
  ends({"E:3A1N1+P1000+P0+P1000", "G:D"});
  EXPECT_EQ(refusal({"E:3A1N1+P1000+P0+P6283"}), "TOO_FAST 3");
  EXPECT_EQ(refusal({"EP:3A1N1+P1000+P0+P3000", "DS:1F200000", "G:D"}), "TOO_FAST 3") << "0.43 of twice as much";
}

TEST_F(ForecastTest, HomeComesFirst) {
  profile.axes[0].require_homing = true;
  for (const std::string line :
       {"M:1+P1", "A:1+P1", "MP:1+P1", "AP:1+P1", "K:A+P1+P1", "KP:B+P1+P1", "E:0A0+P100+P0", "Z:1", "ZRT:1", "ZRT:"}) {
    EXPECT_EQ(refusal({line}), "NOT_HOMED 1") << line;
  }
  ends({"HRT:1", "M:2+P1", "G:2", "D:1S100F1000R100"});
  state.axes[0].homed = true;
  ends({"M:1+P1", "G:1", "Z:1"});
}

TEST_F(ForecastTest, TheLogicalOriginLiesWithinTheTravelAndTheMechanicalOneNeedNot) {
  profile.axes[0].travel_minimum = pulses(1);
  EXPECT_EQ(refusal({"Z:1"}), "OUTSIDE_TRAVEL 1");
  EXPECT_EQ(refusal({"ZRT:A"}), "OUTSIDE_TRAVEL 1");
  EXPECT_THAT(ends({"HRT:1"}), ElementsAre(0, 2000, 3000));
}

TEST_F(ForecastTest, AWayFromNowhereLeadsNowhere) {
  start[0].reset();
  for (const std::string line : {"M:1+P1", "MP:1+P1", "K:A+P1+P1", "KP:B+P1+P1", "E:0A0+P100+P0", "EP:0A0+P100+P0"}) {
    EXPECT_EQ(refusal({line}), "POSITION_UNKNOWN 1") << line;
  }
  EXPECT_THAT(ends({"A:1+P5", "G:1", "M:1+P1", "G:1"}), ElementsAre(6, 2000, 3000));
}

TEST_F(ForecastTest, AxesThatCannotBeMoved) {
  state.axes[2].controllable = false;
  EXPECT_EQ(refusal({"M:3+P1"}), "UNKNOWN_AXIS 3");
  EXPECT_EQ(refusal({"E:0B0+P100+P0"}), "UNKNOWN_AXIS 3");
  EXPECT_EQ(refusal({"E:3A0N1+P100+P0+P1"}), "UNKNOWN_AXIS 3") << "which goes along";
  EXPECT_THAT(ends({"M:W+P1+P2", "G"}), ElementsAre(1001, 2002, 3000)) << "W: those that can";
  profile.axes[0].stage = StageProfile{"OSMS20-85", {{1000, 0}, false}, {}};
  for (const std::string line : {"M:1+P1", "HRT:1", "Z:1", "D:1S100F1000R100", "E:0A0+P100+P0"}) {
    EXPECT_EQ(refusal({line}), "IDENTITY_MISMATCH 1") << line;
  }
}

TEST_F(ForecastTest, CurvesThatAreNone) {
  EXPECT_EQ(refusal({"E:2A0+P100+P100+P200+P200"}), "INVALID_REQUEST") << "three points on one line";
  state.axes[1].scale = Scale{{20, 0}, false};
  EXPECT_EQ(refusal({"E:0A0+P100+P0"}), "INVALID_REQUEST") << "manual 71): pulses that are not equally long";
  ends({"E:0B0+P100+P0", "G:B"});
}

// Manual 83), 84): "The distance traveled per pulse must be the same between the interpolation axes."
TEST_F(ForecastTest, LinesOfPulsesThatAreNotEquallyLong) {
  state.axes[1].scale = Scale{{20, 0}, false};
  for (const std::string line : {"K:A+P1+P1", "K:D+P1+P1+P1", "KP:C+P1+P1"}) {
    EXPECT_EQ(refusal({line}), "INVALID_REQUEST") << line;
  }
  ends({"K:B+P1+P1", "G:B", "M:A+P1+P1", "G:A"});
}

// In a chain, the first setting may have started by itself, or may be overwritten.
TEST_F(ForecastTest, ASecondPrebufferSettingBehindAStartLeavesOpenWhereItBegins) {
  EXPECT_EQ(refusal({"MP:1+P1", "G:1", "MP:1+P1", "MP:1+P1"}), "INVALID_REQUEST 1");
  EXPECT_EQ(refusal({"HRT:1", "MP:1+P1", "AP:1+P1"}), "INVALID_REQUEST 1");
  EXPECT_EQ(refusal({"M:1+P1", "G:1", "KP:A+P1+P1", "EP:0A0+P100+P0"}), "INVALID_REQUEST 1");
  ends({"MP:1+P1", "G:1", "MP:2+P1", "MP:1+P1", "G:A"});
}

TEST_F(ForecastTest, NobodyKnowsWhereAProgramLeads) {
  EXPECT_EQ(refusal({"P:S"}), "OUTSIDE_TRAVEL 1");
  EXPECT_EQ(refusal({"P:O"}), "OUTSIDE_TRAVEL 1");
  profile.axes[0] = profile.axes[1] = {};
  EXPECT_EQ(refusal({"P:S"}), "OUTSIDE_TRAVEL 3") << "one bounded axis is enough";
  profile.axes[2] = {};
  EXPECT_THAT(ends({"P:S"}), ElementsAre(kUnknown, kUnknown, kUnknown));
}

class ForecastGoToTest : public ForecastTest {
 protected:
  std::string go_to(const Positions& place) {
    const Envelope envelope(profile, state, "unix alice", "operator");
    TransactionPrediction forecast(envelope, start, speeds, state.controllable());
    const auto good = forecast.go_to(place);
    at = forecast.at();
    return good ? "good" : std::string(name(good.error().reason)) + " " + std::to_string(good.error().axis.value_or(0));
  }
  Positions at;
};

TEST_F(ForecastGoToTest, ASavedPositionIsOfAllAxesThatItNames) {
  EXPECT_EQ(go_to({10, kUnknown, -30}), "good");
  EXPECT_THAT(at, ElementsAre(10, 2000, -30));
  state.axes[2].controllable = false;
  EXPECT_EQ(go_to({10, 20, 999'999'999}), "good");
  EXPECT_THAT(at, ElementsAre(10, 20, 3000));
}

TEST_F(ForecastGoToTest, IsWithinTheEnvelope) {
  EXPECT_EQ(go_to({0, 500'001, 0}), "OUTSIDE_TRAVEL 2");
  EXPECT_EQ(go_to({500'000, -500'000, 0}), "good");
  speeds[3].maximum = 200'001;
  EXPECT_EQ(go_to({0, 0, 0}), "TOO_FAST 3") << "each at its own speed";
  EXPECT_EQ(go_to({0, 0, kUnknown}), "good");
  profile.axes[1].require_homing = true;
  EXPECT_EQ(go_to({0, 0, kUnknown}), "NOT_HOMED 2");
  profile.axes[0].stage = StageProfile{"OSMS20-85", {{1000, 0}, false}, {}};
  EXPECT_EQ(go_to({0, 0, kUnknown}), "IDENTITY_MISMATCH 1");
}

}  // namespace
}  // namespace axisgate::shrc203::transaction_prediction_test
