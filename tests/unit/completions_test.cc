#include "device/shrc203/completions.h"

#include <gtest/gtest.h>

namespace axisgate::shrc203 {
namespace {

using std::chrono::milliseconds;

const AxisSet kOne = AxisSet::of(1), kTwo = AxisSet::of(2), kBoth = AxisSet::of(1) | AxisSet::of(2);

TimePoint at(int ms) { return TimePoint{} + milliseconds(ms); }

TEST(Completions, AfterAConnectEveryAxisMayComplete) {
  Completions completions;
  EXPECT_EQ(completions.possible(), AxisSet());
  completions.connected();
  EXPECT_EQ(completions.possible(), AxisSet::all());
  EXPECT_EQ(completions.outstanding(), AxisSet::all());
}

TEST(Completions, PossibleFromTheStartOn) {
  Completions completions;
  completions.started(kTwo, at(0));
  EXPECT_TRUE(completions.possible(2));
  EXPECT_FALSE(completions.possible(1));
  EXPECT_EQ(completions.outstanding(), kTwo);
}

// A chain tells one for each segment, so one that has come does not end it.
TEST(Completions, StillPossibleAfterOneHasArrived) {
  Completions completions;
  completions.started(kOne, at(0));
  completions.arrived(1);
  EXPECT_EQ(completions.possible(), kOne);
  EXPECT_EQ(completions.outstanding(), AxisSet());
}

TEST(Completions, EndByAnExchangeWrittenTwoHundredMillisecondsAfterReady) {
  Completions completions;
  completions.started(kOne, at(0));
  completions.answered(at(500));
  EXPECT_EQ(completions.possible(), kOne) << "nothing was READY";
  completions.ready(kOne, at(1000));
  EXPECT_EQ(completions.settles_from(kOne), at(1200));
  completions.answered(at(1199));
  EXPECT_EQ(completions.possible(), kOne);
  completions.answered(at(1200));
  EXPECT_EQ(completions.possible(), AxisSet());
}

TEST(Completions, TheFirstReadyCounts) {
  Completions completions;
  completions.started(kOne, at(0));
  completions.ready(kOne, at(1000));
  completions.ready(kOne, at(1100));
  EXPECT_EQ(completions.settles_from(kOne), at(1200));
}

TEST(Completions, BusyAgainTakesReadyBack) {
  Completions completions;
  completions.started(kOne, at(0));
  completions.ready(kOne, at(1000));
  completions.busy(kOne);
  EXPECT_EQ(completions.settles_from(kOne), std::nullopt);
  completions.answered(at(5000));
  EXPECT_EQ(completions.possible(), kOne);
}

TEST(Completions, AnAxisThatMovesUnaskedMayComplete) {
  Completions completions;
  EXPECT_EQ(completions.busy(kTwo), kTwo);
  EXPECT_EQ(completions.outstanding(), kTwo);
  EXPECT_EQ(completions.busy(kTwo), AxisSet()) << "no news";
  completions.ready(kTwo, at(1000));
  completions.answered(at(1200));
  EXPECT_EQ(completions.possible(), AxisSet());
}

// READY so soon may be the answer of the time before the start.
TEST(Completions, ReadyRightAfterTheStartIsNotBelieved) {
  Completions completions;
  completions.started(kOne, at(0));
  completions.ready(kOne, at(149));
  EXPECT_EQ(completions.settles_from(kOne), std::nullopt);
  completions.ready(kOne, at(150));
  EXPECT_EQ(completions.settles_from(kOne), at(350));
}

TEST(Completions, SettlesWhenTheLastAxisDoes) {
  Completions completions;
  completions.started(kBoth, at(0));
  completions.ready(kOne, at(1000));
  EXPECT_EQ(completions.settles_from(kBoth), std::nullopt);
  EXPECT_EQ(completions.settles_from(kOne), at(1200));
  completions.ready(kTwo, at(1500));
  EXPECT_EQ(completions.settles_from(kBoth), at(1700));
}

TEST(Completions, ANewStartBeginsAnew) {
  Completions completions;
  completions.started(kOne, at(0));
  completions.arrived(1);
  completions.ready(kOne, at(1000));
  completions.started(kOne, at(1100));
  completions.answered(at(1300));
  EXPECT_EQ(completions.outstanding(), kOne);
}

}  // namespace
}  // namespace axisgate::shrc203
