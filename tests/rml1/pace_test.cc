// Tests of the time at which a mill of a given pace has executed the bytes sent to it.
#include "device/rml1/sending/pace.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/rml1/short_vectors.h"

namespace axisgate::rml1 {
namespace {

using std::chrono::milliseconds;

class PaceTest : public testing::Test {
 protected:
  static TimePoint at(int ms) { return TimePoint{} + milliseconds(ms); }

  // Moves of 10 mm at 10 mm/s, a second each. The commands end at bytes 9, 19, 26, 36 and 43.
  const std::string job_ = "!MC0;V10;Z1000,0,0;Z0,0,0;Z1000,0,0;Z0,0,0;";
  const Profile profile_ = measured_profile();
  const Timeline timeline_{job_, profile_, kAtHome};
  Pace pace_{timeline_, &Step::least_s, 1};
};

TEST_F(PaceTest, IsTheTimelinesFromWhenTheBytesArrive) {
  pace_.arrived(26, at(0));
  pace_.arrived(36, at(5000));
  EXPECT_EQ(pace_.when(26), at(2000));
  EXPECT_EQ(pace_.when(36), at(6000));
  EXPECT_EQ(pace_.executed(at(999)), 0u) << "what moves nothing is over with what is behind it";
  EXPECT_EQ(pace_.executed(at(1000)), 19u);
  EXPECT_EQ(pace_.executed(at(5999)), 26u);
}

TEST_F(PaceTest, WhatWasReadIsUnderWayAndWhatWasBeforeIsOver) {
  pace_.arrived(36, at(0));
  pace_.arrived(43, at(10'000));
  pace_.has_read(26, at(500));
  EXPECT_EQ(pace_.executed(at(500)), 19u);
  EXPECT_EQ(pace_.when(26), at(1500));
  EXPECT_EQ(pace_.when(36), at(2500));
  EXPECT_EQ(pace_.when(43), at(11'000)) << "not before it arrives";
}

TEST_F(PaceTest, ReadingNeverDelays) {
  pace_.arrived(36, at(0));
  pace_.has_read(26, at(500));
  pace_.has_read(26, at(800));
  EXPECT_EQ(pace_.when(26), at(1500));
  pace_.has_read(5, at(900));
  EXPECT_EQ(pace_.when(36), at(2500));
}

}  // namespace
}  // namespace axisgate::rml1
