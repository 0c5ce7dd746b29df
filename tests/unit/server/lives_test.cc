// The state machines of a path's segment, a jog, a stop and the return to HOST: every state with every event, typed
// from the tables in device/shrc203/README.md.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "device/shrc203/state/jog_life.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/segment_life.h"
#include "device/shrc203/state/stop_life.h"
#include "tests/unit/core/reported.h"
#include "tests/unit/core/transition_table.h"

namespace axisgate::shrc203::lives_test {
namespace {

using testing_tables::illegal_pairs;
using testing_tables::Table;

TEST(SegmentTable, EachPairLeadsWhereThePageSays) {
  const Table table = {
      {"stationary", {"setting", "-", "-", "-", "-", "-", "-", "-", "-"}},
      {"setting", {"-", "running", "doubtful", "-", "-", "-", "-", "-", "-"}},
      {"running", {"-", "-", "-", "refilling", "-", "-", "-", "stationary", "-"}},
      {"refilling", {"-", "-", "-", "-", "chained", "doubtful", "-", "-", "-"}},
      {"chained", {"-", "-", "-", "-", "-", "-", "running", "-", "-"}},
      {"doubtful", {"-", "-", "-", "-", "-", "-", "-", "-", "stationary"}},
  };
  const int illegal = illegal_pairs<SegmentPhase, SegmentEvent>(
      table, kSegmentPhases,
      {"set_asked", "start_accepted", "start_doubted", "refill_asked", "refill_accepted", "refill_doubted", "ended",
       "became_stationary", "found"},
      [](SegmentPhase phase, SegmentEvent event) { return next(phase, event); });
  EXPECT_EQ(illegal, 45);
}

TEST(JogTable, EachPairLeadsWhereThePageSays) {
  const Table table = {
      {"preparing", {"running", "-", "-", "ending", "-", "-"}},
      {"running", {"-", "changing_speed", "-", "ending", "-", "-"}},
      {"changing_speed", {"-", "-", "running", "ending", "-", "-"}},
      {"ending", {"ending", "-", "ending", "ending", "stopping", "-"}},
      {"stopping", {"stopping", "-", "stopping", "stopping", "-", "ending"}},
  };
  const int illegal = illegal_pairs<JogPhase, JogEvent>(
      table, kJogPhases, {"begun", "speed_asked", "speed_answered", "must_end", "stop_asked", "stop_answered"},
      [](JogPhase phase, JogEvent event) { return next(phase, event); });
  EXPECT_EQ(illegal, 16);
}

TEST(StopTable, EachPairLeadsWhereThePageSays) {
  const Table table = {
      {"asked", {"written", "-", "confirmed", "replaced", "withdrawn"}},
      {"written", {"written", "confirmed", "-", "replaced", "withdrawn"}},
      {"confirmed", {"-", "-", "-", "-", "-"}},
      {"replaced", {"-", "-", "-", "-", "-"}},
      {"withdrawn", {"-", "-", "-", "-", "-"}},
  };
  const int illegal = illegal_pairs<StopState, StopEvent>(
      table, stage::kStopStates, {"wrote", "seen_stationary", "returned_stationary", "widened", "abandoned"},
      [](StopState state, StopEvent event) { return next(state, event); });
  EXPECT_EQ(illegal, 17);
}

TEST(NonHostTable, EachPairLeadsWhereThePageSays) {
  const Table table = {
      {"host", {"leaving", "-", "-", "-", "-", "host"}},
      {"leaving", {"-", "leaving", "memory_switches", "program", "program_edit", "host"}},
      {"memory_switches", {"-", "leaving", "memory_switches", "program", "program_edit", "host"}},
      {"program", {"-", "leaving", "memory_switches", "program", "program_edit", "host"}},
      {"program_edit", {"-", "leaving", "memory_switches", "program", "program_edit", "host"}},
  };
  const int illegal = illegal_pairs<NonHostPhase, NonHostEvent>(
      table, kNonHostPhases,
      {"began", "entered_host", "entered_switches", "entered_program", "entered_edit", "returned"},
      [](NonHostPhase phase, NonHostEvent event) { return next(phase, event); });
  EXPECT_EQ(illegal, 8);
}

TEST(NonHost, AnIllegalEventIsReportedAndChangesNothing) {
  Reported reported;
  NonHost non_host(reported);
  non_host.entered(Mode::memory_switches);
  EXPECT_EQ(reported.all, std::vector<std::string>{"non_host host entered_switches"});
  EXPECT_FALSE(non_host.away());
}

TEST(NonHost, OnlyTheEditModesAnswerNoPositions) {
  Reported reported;
  NonHost non_host(reported);
  non_host.began();
  EXPECT_TRUE(non_host.away());
  EXPECT_FALSE(non_host.edits());
  non_host.entered(Mode::program);
  EXPECT_TRUE(non_host.in_program());
  EXPECT_FALSE(non_host.edits());
  non_host.entered(Mode::program_edit);
  EXPECT_TRUE(non_host.edits());
  non_host.returned();
  EXPECT_FALSE(non_host.away());
  EXPECT_TRUE(reported.all.empty());
}

}  // namespace
}  // namespace axisgate::shrc203::lives_test
