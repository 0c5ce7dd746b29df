#include "device/shot/line/completions.h"

#include <gtest/gtest.h>

namespace axisgate::shot::completions_test {
namespace {

using std::chrono::milliseconds;

const AxisSet kFirst = AxisSet::of(1), kSecond = AxisSet::of(2), kFirstTwo = AxisSet::of(1) | AxisSet::of(2);

TimePoint after(int ms) { return TimePoint{} + milliseconds(ms); }

TEST(Completions, AfterAConnectEveryAxisMayComplete) {
  Completions completions{3};
  EXPECT_EQ(completions.possible(), AxisSet());
  completions.connected();
  EXPECT_EQ(completions.possible(), AxisSet::first(3));
  EXPECT_EQ(completions.outstanding(), AxisSet::first(3));
}

TEST(Completions, PossibleFromTheStartOn) {
  Completions completions{3};
  completions.started(kSecond, after(0));
  EXPECT_TRUE(completions.possible(2));
  EXPECT_FALSE(completions.possible(1));
  EXPECT_EQ(completions.outstanding(), kSecond);
}

// A chain reports a completion for each segment, so an axis may complete again after the first.
TEST(Completions, StillPossibleAfterOneHasArrived) {
  Completions completions{3};
  completions.started(kFirst, after(0));
  completions.arrived(1);
  EXPECT_EQ(completions.possible(), kFirst);
  EXPECT_EQ(completions.outstanding(), AxisSet());
}

TEST(Completions, EndByAnExchangeWrittenTwoHundredMillisecondsAfterReady) {
  Completions completions{3};
  completions.started(kFirst, after(0));
  completions.answered(after(500));
  EXPECT_EQ(completions.possible(), kFirst) << "nothing was READY";
  completions.ready(kFirst, after(1000));
  EXPECT_EQ(completions.settles_from(kFirst), after(1200));
  completions.answered(after(1199));
  EXPECT_EQ(completions.possible(), kFirst);
  completions.answered(after(1200));
  EXPECT_EQ(completions.possible(), AxisSet());
}

TEST(Completions, TheFirstReadyCounts) {
  Completions completions{3};
  completions.started(kFirst, after(0));
  completions.ready(kFirst, after(1000));
  completions.ready(kFirst, after(1100));
  EXPECT_EQ(completions.settles_from(kFirst), after(1200));
}

TEST(Completions, BusyAgainTakesReadyBack) {
  Completions completions{3};
  completions.started(kFirst, after(0));
  completions.ready(kFirst, after(1000));
  completions.busy(kFirst);
  EXPECT_EQ(completions.settles_from(kFirst), std::nullopt);
  completions.answered(after(5000));
  EXPECT_EQ(completions.possible(), kFirst);
}

TEST(Completions, AnAxisThatMovesUnaskedMayComplete) {
  Completions completions{3};
  EXPECT_EQ(completions.busy(kSecond), kSecond);
  EXPECT_EQ(completions.outstanding(), kSecond);
  EXPECT_EQ(completions.busy(kSecond), AxisSet()) << "no news";
  completions.ready(kSecond, after(1000));
  completions.answered(after(1200));
  EXPECT_EQ(completions.possible(), AxisSet());
}

// READY this soon after the start may still describe the time before the start.
TEST(Completions, ReadyRightAfterTheStartIsNotBelieved) {
  Completions completions{3};
  completions.started(kFirst, after(0));
  completions.ready(kFirst, after(149));
  EXPECT_EQ(completions.settles_from(kFirst), std::nullopt);
  completions.ready(kFirst, after(150));
  EXPECT_EQ(completions.settles_from(kFirst), after(350));
}

TEST(Completions, SettlesWhenTheLastAxisDoes) {
  Completions completions{3};
  completions.started(kFirstTwo, after(0));
  completions.ready(kFirst, after(1000));
  EXPECT_EQ(completions.settles_from(kFirstTwo), std::nullopt);
  EXPECT_EQ(completions.settles_from(kFirst), after(1200));
  completions.ready(kSecond, after(1500));
  EXPECT_EQ(completions.settles_from(kFirstTwo), after(1700));
}

// A segment of the chain has started the axis again since it was READY; an answer that shows this does not settle it.
TEST(Completions, AnAnswerThatShowsAnAxisBusyDoesNotSettleIt) {
  Completions completions{3};
  completions.started(kFirstTwo, after(0));
  completions.ready(kFirstTwo, after(1000));
  completions.answered(after(2000), kFirst);
  EXPECT_EQ(completions.possible(), kFirst);
  completions.answered(after(2010));
  EXPECT_EQ(completions.possible(), AxisSet());
}

TEST(Completions, ANewStartBeginsAnew) {
  Completions completions{3};
  completions.started(kFirst, after(0));
  completions.arrived(1);
  completions.ready(kFirst, after(1000));
  completions.started(kFirst, after(1100));
  completions.answered(after(1300));
  EXPECT_EQ(completions.outstanding(), kFirst);
}

// A recording of another controller, or a damaged one, may name any axis of a stage.
TEST(Completions, AxesThatTheControllerDoesNotHaveAreIgnored) {
  Completions completions{3};
  const AxisSet beyond = AxisSet::of(8) | AxisSet::of(4);
  completions.started(beyond, TimePoint{});
  completions.chained(beyond, TimePoint{});
  EXPECT_EQ(completions.busy(beyond), AxisSet());
  EXPECT_EQ(completions.ready(beyond, TimePoint{}), AxisSet());
  EXPECT_EQ(completions.possible(), AxisSet());
  EXPECT_FALSE(completions.settles_from(beyond));
}

}  // namespace
}  // namespace axisgate::shot::completions_test
