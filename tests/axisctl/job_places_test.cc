// Tests of the places in a job that are typed with --from.
#include "clients/axisctl/mill/job_places.h"

#include <gtest/gtest.h>

#include "clients/axisctl/failure.h"

namespace axisgate::axisctl {
namespace {

using jobs::Place;
using jobs::PlaceRange;

TEST(JobPlaces, ALineOrALineAndAColumn) {
  EXPECT_EQ(job_place("12"), (Place{0, 12, 1}));
  EXPECT_EQ(job_place("1:340"), (Place{0, 1, 340}));
}

TEST(JobPlaces, ARange) {
  EXPECT_EQ(job_range("12"), (PlaceRange{{0, 12, 1}, {0, 12, 1}}));
  EXPECT_EQ(job_range("8:3-13"), (PlaceRange{{0, 8, 3}, {0, 13, 1}}));
  EXPECT_EQ(job_range("8:3-8:3"), (PlaceRange{{0, 8, 3}, {0, 8, 3}}));
}

TEST(JobPlaces, WhatIsNoRange) {
  for (const char* text : {"", "-", "0", "8-", "-8", "8-0", "13-8", "8:4-8:3", "8-9-10", "8 - 9", "8..9", "8:-9",
                           "99999999999999999999"}) {
    EXPECT_THROW((void)job_range(text), Failure) << text;
  }
}

}  // namespace
}  // namespace axisgate::axisctl
