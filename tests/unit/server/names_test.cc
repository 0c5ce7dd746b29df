#include <gtest/gtest.h>

#include <set>
#include <string_view>

#include "device/core/lane.h"
#include "device/core/problem.h"
#include "device/shot/command/status.h"
#include "device/shrc203/command/refusals.h"
#include "device/stage/event.h"
#include "device/stage/motion.h"
#include "device/stage/state.h"

namespace axisgate::names_test {
namespace {

template <class Enum>
void expect_names(std::initializer_list<std::string_view> names) {
  int value = 0;
  for (const std::string_view expected : names) EXPECT_EQ(name(static_cast<Enum>(value++)), expected);
}

// Clients depend on these names: a changed name or order breaks them.
TEST(Names, OfReasonsStayAsPublished) {
  expect_names<Reason>({"UNSPECIFIED",       "INVALID_REQUEST", "UNKNOWN_DEVICE",    "UNKNOWN_AXIS",
                        "UNKNOWN_UNIT",      "OUT_OF_RANGE",    "OUTSIDE_TRAVEL",    "TOO_FAST",
                        "NOT_REPRESENTABLE", "MALFORMED_LINE",  "UNKNOWN_COMMAND",   "INCOMPLETE_TRANSACTION",
                        "NOT_FOUND",         "AXIS_BUSY",       "NOT_EXCITED",       "LIMIT_DETECTED",
                        "EMERGENCY_STOPPED", "DEVICE_ERROR",    "WRONG_MODE",        "STALE_SETPOINT",
                        "POSITION_UNKNOWN",  "DEVICE_REFUSED",  "IDENTITY_MISMATCH", "LINK_DOWN",
                        "NOT_SENT",          "REPLY_TIMED_OUT", "LINE_FAULT",        "COMPLETION_OUTSTANDING",
                        "DEADLINE_PASSED",   "QUEUE_FULL",      "STOPPED",           "TARGET_NOT_REACHED",
                        "OUTCOME_UNKNOWN",   "COMPACTED",       "INTERNAL"});
}

TEST(Names, OfLanes) { expect_names<Lane>({"stop", "path_refill", "motion", "question", "poll"}); }

namespace device = shrc203;

TEST(Names, OfMotions) {
  expect_names<device::MotionKind>({"move", "home", "return-to-origin", "path", "execute", "jog"});
  expect_names<device::MotionState>({"QUEUED", "RUNNING", "STOPPING", "SUCCEEDED", "STOPPED", "FAILED", "UNKNOWN"});
}

TEST(Names, OnlyTheLastFourMotionStatesAreOutcomes) {
  using device::MotionState;
  for (const MotionState state : {MotionState::queued, MotionState::running, MotionState::stopping}) {
    EXPECT_FALSE(device::is_outcome(state)) << name(state);
  }
  for (const MotionState state :
       {MotionState::succeeded, MotionState::stopped, MotionState::failed, MotionState::unknown}) {
    EXPECT_TRUE(device::is_outcome(state)) << name(state);
  }
}

TEST(Names, OfLinkStates) { expect_names<device::LinkState>({"DOWN", "CONNECTING", "UP", "DOUBTFUL"}); }

TEST(Names, OfExchangeOutcomes) {
  expect_names<device::ExchangeEnded::Outcome>(
      {"ok", "ok_d", "ng", "ng_i", "data", "timed_out", "garbled", "link_lost"});
}

bool shows_error(std::uint32_t status) {
  device::State state;
  state.axis(1).status_bits = status;
  return device::error_shown(device::AxisSet::of(1), state).has_value();
}

// Manual 5) Q:S, table of the status bits, numbered from 1.
TEST(AxisStatusBits, TellErrorsFromWarningsAndStates) {
  const std::set<int> errors = {3, 4, 5, 6, 7, 8, 9, 10, 13, 15};
  for (int number = 1; number <= 25; ++number) {
    const shot::AxisStatusBits status{1u << (number - 1)};
    EXPECT_EQ(shows_error(status.raw), errors.contains(number)) << "bit " << number;
    EXPECT_EQ(status.cw_limit(), number == 20) << "bit " << number;
    EXPECT_EQ(status.ccw_limit(), number == 21) << "bit " << number;
  }
}

// Manual 5) Q:S: status 1 is normal, 4 is a scale error; 1000002 is from a real unit's answer.
TEST(AxisStatusBits, ReadTheManualsExamples) {
  EXPECT_FALSE(shows_error(0x1));
  EXPECT_TRUE(shows_error(0x4));
  EXPECT_FALSE(shows_error(0x1000002));
}

TEST(State, ListsItsControllableAxes) {
  device::State state;
  EXPECT_TRUE(state.controllable().empty());
  state.axis(1).controllable = true;
  state.axis(3).controllable = true;
  EXPECT_EQ(state.controllable(), device::AxisSet::of(1) | device::AxisSet::of(3));
}

}  // namespace
}  // namespace axisgate::names_test
