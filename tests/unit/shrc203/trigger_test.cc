// The trigger output: its lines and the answer of ?:T. Bytes from manual 42), 97) to 101).
#include "device/shrc203/command/trigger.h"

#include <gtest/gtest.h>

#include "device/shot/command/trigger_reply.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203::trigger_test {
namespace {

using Target = Trigger::Target;

TEST(Trigger, IsReadAsTheManualShowsIt) {
  EXPECT_EQ(parse_trigger("0,1,1000", model().axes()), (Trigger{Target::drive_pulses, 1, 1000}));
  EXPECT_EQ(parse_trigger("1,20", model().axes()), (Trigger{Target::timer, 0, 20}));
  EXPECT_EQ(parse_trigger("NS", model().axes()), Trigger{});
  EXPECT_EQ(parse_trigger("2,3,30000", model().axes()), (Trigger{Target::scale_plus, 3, 30'000}));
  EXPECT_EQ(parse_trigger("3,2,-100", model().axes()), (Trigger{Target::scale_minus, 2, 100}));
  EXPECT_EQ(parse_trigger("3,2,100", model().axes()), (Trigger{Target::scale_minus, 2, 100}));
}

TEST(Trigger, WhatNoTriggerCanBeIsNone) {
  for (const char* answer : {"", "OK", "0", "0,1", "1", "1,1,20", "4,1,20", "-1,1,20", "0,4,1000", "0,0,1000", "0,1,1",
                             "0,1,30001", "1,0", "1,10001", "0,1,1000,", "0,,1000", "0,1,-5", "2,1,x"}) {
    EXPECT_EQ(parse_trigger(answer, model().axes()), std::nullopt) << answer;
  }
}

TEST(Trigger, IsSetAsTheManualShowsIt) {
  EXPECT_EQ(trigger_command({Target::timer, 0, 100}).line, "T:T100");
  EXPECT_EQ(trigger_command({Target::drive_pulses, 2, 5}).line, "T:P2P5");
  EXPECT_EQ(trigger_command({Target::scale_plus, 1, 2}).line, "T:E1P+2");
  EXPECT_EQ(trigger_command({Target::scale_minus, 1, 2}).line, "T:E1P-2");
  EXPECT_EQ(trigger_command({}).line, "T:S");
}

TEST(Trigger, ALineTellsWhatItSets) {
  for (const Trigger& trigger : {Trigger{}, Trigger{Target::timer, 0, 10'000}, Trigger{Target::drive_pulses, 3, 2},
                                 Trigger{Target::scale_plus, 1, 7}, Trigger{Target::scale_minus, 2, 30'000}}) {
    EXPECT_EQ(trigger_of(trigger_command(trigger)), trigger);
  }
  EXPECT_EQ(trigger_of(model().make("T:M")), std::nullopt);
  EXPECT_EQ(trigger_of(model().make("?:T")), std::nullopt);
}

}  // namespace
}  // namespace axisgate::shrc203::trigger_test
