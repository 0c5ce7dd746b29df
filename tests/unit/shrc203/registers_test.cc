#include "device/shrc203/state/registers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "device/shrc203/command/builders.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203::registers_test {
namespace {

const AxisSet kAll = kAllAxes;

std::string_view question_of(Register reg) { return commands::text(commands::question_of(reg)); }

Reply reply_of(std::string_view question, std::string_view line, AxisSet controllable = kAll) {
  auto reply = parse_reply(model(), model().row(question), line, controllable.count());
  EXPECT_TRUE(reply) << question << " " << line;
  return reply.value_or(Reply{});
}

class RegistersTest : public testing::Test {
 protected:
  void take(std::string_view question, std::string_view line, AxisSet controllable = kAll) {
    const auto reg = std::ranges::find(Registers::all(), question, question_of);
    reading.take(*reg, reply_of(question, line, controllable), controllable);
    registers.end_reading(reading);
  }
  Registers registers;
  Registers::Reading reading = registers.begin_reading();
};

TEST(RegistersUnread, NobodyKnows) {
  Registers registers;
  EXPECT_FALSE(registers.known());
  const auto reading = registers.begin_reading();
  EXPECT_FALSE(registers.known());
  registers.end_reading(reading);
  EXPECT_TRUE(registers.known());
  registers.forget();
  EXPECT_FALSE(registers.known());
}

TEST(RegistersUnread, WhatIsForgottenMeanwhileIsNotKnown) {
  Registers registers;
  const auto reading = registers.begin_reading();
  registers.forget();
  registers.end_reading(reading);
  EXPECT_FALSE(registers.known());
}

// Manual 85): registers that G starts.
TEST(RegistersUnread, AsksForEveryRegister) {
  std::vector<std::string_view> questions;
  for (const Register reg : Registers::all()) questions.push_back(question_of(reg));
  EXPECT_THAT(questions, testing::UnorderedElementsAre("?:M", "?:A", "?:K", "?:E", "?:J", "?:MP", "?:AP", "?:KP",
                                                       "?:EP", "?:WT", "?:WI"));
}

TEST_F(RegistersTest, NothingSet) {
  for (const Register reg : Registers::all()) {
    const auto question = question_of(reg);
    const bool shared = question == "?:K" || question == "?:E" || question == "?:KP" || question == "?:EP";
    take(question, shared ? "NS" : "NS,NS,NS");
  }
  EXPECT_FALSE(registers.any());
}

TEST_F(RegistersTest, WhatGcDeletesIsToldFromWhatLasts) {
  take("?:M", "NS,2000,NS");
  take("?:MP", "NS,NS,-5");
  take("?:J", "+,NS,NS");
  EXPECT_EQ(registers.clearable(), AxisSet::of(2));
  EXPECT_EQ(registers.lasting(), AxisSet::of(1) | AxisSet::of(3));
  registers.cleared(AxisSet::of(2));
  EXPECT_EQ(registers.clearable(), AxisSet());
  EXPECT_EQ(registers.lasting(), AxisSet::of(1) | AxisSet::of(3));
  EXPECT_TRUE(registers.any());
}

TEST_F(RegistersTest, ClearsTheAxesNamedOnly) {
  take("?:A", "1000,2000,3000");
  registers.cleared(AxisSet::of(1) | AxisSet::of(3));
  EXPECT_EQ(registers.set_in(Register::a), AxisSet::of(2));
}

// The effect on a line or curve is unknown if GC: names only a part of its axes.
TEST_F(RegistersTest, ALineIsClearedWithAllItsAxes) {
  take("?:K", "A,1000,200");
  registers.cleared(AxisSet::of(1));
  EXPECT_EQ(registers.clearable(), AxisSet::of(1) | AxisSet::of(2));
  registers.cleared(AxisSet::of(1) | AxisSet::of(2));
  EXPECT_EQ(registers.clearable(), AxisSet());
}

// Manual 22) and 24): E reports its axes in the second field, K in the first.
TEST_F(RegistersTest, InterpolationsNameTheirAxes) {
  take("?:KP", "A,1000,200");
  take("?:E", "0,B,0,100,100");
  EXPECT_EQ(registers.set_in(Register::kp), AxisSet::of(1) | AxisSet::of(2));
  EXPECT_EQ(registers.set_in(Register::e), AxisSet::of(1) | AxisSet::of(3));
}

// With ?:AXIS 4 (1+3) the answer has two fields, and the second is axis 3's.
TEST_F(RegistersTest, FieldsOfTheControllableAxesOnly) {
  const AxisSet two = AxisSet::of(1) | AxisSet::of(3);
  take("?:M", "NS,500", two);
  EXPECT_EQ(registers.set_in(Register::m), AxisSet::of(3));
  EXPECT_EQ(amount_of(reply_of("?:M", "NS,500", two), 3, two), 500);
  EXPECT_EQ(amount_of(reply_of("?:M", "NS,500", two), 1, two), std::nullopt);
  EXPECT_EQ(amount_of(reply_of("?:M", "NS,500", two), 2, two), std::nullopt);
}

TEST_F(RegistersTest, AmountsAreSigned) {
  EXPECT_EQ(amount_of(reply_of("?:MP", "1000,-2000,NS"), 2, kAll), -2000);
  EXPECT_EQ(amount_of(reply_of("?:MP", "1000,-2000,NS"), 3, kAll), std::nullopt);
}

}  // namespace
}  // namespace axisgate::shrc203::registers_test
