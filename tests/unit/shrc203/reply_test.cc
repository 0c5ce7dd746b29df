// Possible answers to each command, and their meaning; the examples are from the manual.
#include "device/shot/command/reply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203::reply_test {
namespace {

using testing::ElementsAre;

std::optional<Reply> parse(std::string_view row, std::string_view line, int axes = 3) {
  return parse_reply(model(), model().row(row), line, axes);
}
bool fits(std::string_view row, std::string_view line, int axes = 3) { return parse(row, line, axes).has_value(); }

TEST(Reply, AnswersToSettings) {
  EXPECT_EQ(parse("M:", "OK")->kind, Reply::Kind::ok);
  EXPECT_EQ(parse("MP:", "OK_D")->kind, Reply::Kind::ok_d);
  EXPECT_EQ(parse("M:", "NG")->kind, Reply::Kind::ng);
  EXPECT_EQ(parse("M:", "NG_I")->kind, Reply::Kind::ng_i);
  EXPECT_TRUE(parse("MP:", "OK_D")->accepted());
  EXPECT_FALSE(parse("MP:", "NG")->accepted());
  for (const char* line : {"ok", "OK_", "OKD", "O", "OK OK", "1", "", "R", "K"}) EXPECT_FALSE(fits("M:", line)) << line;
}

TEST(Reply, OnlyPrebufferCommandsAreAnsweredByOkD) {
  for (const char* row : {"MP:", "AP:", "KP:"}) EXPECT_TRUE(fits(row, "OK_D")) << row;
  for (const char* row : {"M:", "A:", "K:", "G:", "G", "HRT:", "D:", "L:"}) EXPECT_FALSE(fits(row, "OK_D")) << row;
}

TEST(Reply, QuestionsAreNotAnsweredByOk) {
  for (const auto& row : model().commands()) {
    if (row.effect != Effect::question) continue;
    EXPECT_FALSE(parse_reply(model(), row, "OK", 3)) << row.name;
    EXPECT_TRUE(parse_reply(model(), row, "NG", 3)) << row.name;
    EXPECT_TRUE(parse_reply(model(), row, "NG_I", 3)) << row.name;
  }
}

// Design: these rows are matched by grammar alone, so none of their answers may be a bare axis number.
TEST(Reply, RowsSeparatedByGrammarAreNeverABareAxisNumber) {
  for (const auto& row : model().commands()) {
    if (row.separation != Separation::grammar) continue;
    for (const char* number : {"1", "2", "3"}) EXPECT_FALSE(parse_reply(model(), row, number, 1)) << row.name;
    EXPECT_FALSE(bare_number_range(row)) << row.name;
  }
}

// With three axes the answers of these rows contain commas, whatever their values.
TEST(Reply, RowsAskedForAllAxesHaveCommas) {
  for (const auto& row : model().commands()) {
    if (row.separation != Separation::all_axes) continue;
    for (const char* number : {"1", "2", "3"}) EXPECT_FALSE(parse_reply(model(), row, number, 3)) << row.name;
  }
}

TEST(Reply, RangesOfBareNumbers) {
  EXPECT_EQ(bare_number_range(model().row("?:SLEEP"))->maximum, 1);
  EXPECT_EQ(bare_number_range(model().row("?:AXIS"))->maximum, 6);
  EXPECT_EQ(bare_number_range(model().row("I:"))->maximum, 63);
  EXPECT_EQ(bare_number_range(model().row("?:W"))->maximum, 2550);
  EXPECT_EQ(bare_number_range(model().row("?:C"))->minimum, 0);
}

TEST(Reply, NumbersInTheirRange) {
  EXPECT_TRUE(fits("?:AXIS", "6"));
  EXPECT_FALSE(fits("?:AXIS", "7"));
  EXPECT_FALSE(fits("?:AXIS", "-1"));
  EXPECT_FALSE(fits("?:AXIS", "1,1"));
  EXPECT_TRUE(fits("?:W", "2550"));
  EXPECT_FALSE(fits("?:W", "2551"));
  EXPECT_FALSE(fits("I:", "64"));
  EXPECT_TRUE(fits("?:C", "1,0,1"));
  EXPECT_FALSE(fits("?:C", "1,2,1"));
}

// Manual 8), 13), 18), 24), 22), 31): answers exactly as printed.
TEST(Reply, TheManualsExamples) {
  EXPECT_TRUE(fits("?:V", "V2.00.000"));
  EXPECT_TRUE(fits("?:N", "SHRC-203"));
  EXPECT_TRUE(fits("?:D", "S100F1000R100, S200F2000R200, S300F3000R300"));
  EXPECT_TRUE(fits("?:M", "1000,2000,3000"));
  EXPECT_TRUE(fits("?:M", "NS,NS,NS"));
  EXPECT_TRUE(fits("?:K", "NS"));
  EXPECT_TRUE(fits("?:E", "0,A,0,100,100"));
  EXPECT_TRUE(fits("?:E", "2,A,0,100,100,200,0"));
  EXPECT_TRUE(fits("?:J", "+, -", 2));
  EXPECT_TRUE(fits("?:WT", "255,255", 2));
  EXPECT_TRUE(fits("!:", "R"));
  EXPECT_TRUE(fits("SRQ:", "K, K, R"));
  EXPECT_TRUE(fits("SRQ:S", "1,1,1,R,B,R"));
  EXPECT_TRUE(fits("?:FMT", "HIT"));
  EXPECT_TRUE(fits("?:CMD", "WI:W,C"));
}

TEST(Reply, BlanksAfterCommasAreNoPartOfAField) {
  EXPECT_THAT(parse("?:D", "S100F1000R100, S200F2000R200, S300F3000R300")->fields,
              ElementsAre("S100F1000R100", "S200F2000R200", "S300F3000R300"));
}

TEST(Reply, AsManyFieldsAsAxes) {
  EXPECT_TRUE(fits("?:M", "1000,2000", 2));
  EXPECT_TRUE(fits("?:M", "1000,2000,0", 2)) << "an invalid axis may stay";
  EXPECT_FALSE(fits("?:M", "1000,2000", 3));
  EXPECT_FALSE(fits("?:M", "1000,2000,3000,4000"));
  EXPECT_FALSE(fits("?:M", "1000,,3000"));
  EXPECT_TRUE(fits("?:M", "1000,2000", 0)) << "before ?:AXIS any count is possible";
}

TEST(Reply, CutOrDamagedAnswersAreNone) {
  const std::string whole = "P+123,P+0,P-5,1,1,1,R,R,R";
  ASSERT_TRUE(fits("Q:S", whole));
  for (std::size_t length = 0; length < whole.size(); ++length) {
    EXPECT_FALSE(fits("Q:S", whole.substr(0, length))) << whole.substr(0, length);
  }
  for (std::size_t from = 2; from < whole.size(); ++from) {
    EXPECT_FALSE(fits("Q:S", whole.substr(from))) << whole.substr(from);
  }
  EXPECT_FALSE(fits("Q:S", "P+123,P+0,P-5,1,1,1,R,R,X"));
  EXPECT_FALSE(fits("Q:S", "P+1O3,P+0,P-5,1,1,1,R,R,R"));
  EXPECT_FALSE(fits("Q:S", "P+123,P+0,P-5,1,G,1,R,R,R"));
}

TEST(Reply, Positions) {
  const auto readings = parse_positions(model(), *parse("Q:S", "P+100,P-2000,P3000,80,1,4,R,B,B"), kAllAxes);
  ASSERT_TRUE(readings);
  EXPECT_EQ((*readings)[0].pulses, 100);
  EXPECT_EQ((*readings)[1].pulses, -2000);
  EXPECT_EQ((*readings)[2].pulses, 3000);
  EXPECT_TRUE((*readings)[0].status.bit(8)) << "bit 8";
  EXPECT_FALSE((*readings)[0].busy);
  EXPECT_TRUE((*readings)[1].busy);
  EXPECT_TRUE((*readings)[2].status.bit(3)) << "bit 3";
}

// Manual 5): an invalid axis replies 0 and D.
TEST(Reply, PositionsOfInvalidAxes) {
  const auto kept =
      parse_positions(model(), *parse("Q:S", "P+1,0,P+3,1,0,1,R,D,R", 2), AxisSet::of(1) | AxisSet::of(3));
  ASSERT_TRUE(kept);
  EXPECT_FALSE((*kept)[1].valid);
  EXPECT_EQ((*kept)[2].pulses, 3);
  const auto left_out = parse_positions(model(), *parse("Q:S", "P+1,P+3,1,1,R,R", 2), AxisSet::of(1) | AxisSet::of(3));
  ASSERT_TRUE(left_out);
  EXPECT_FALSE((*left_out)[1].valid);
  EXPECT_EQ((*left_out)[2].pulses, 3);
}

TEST(Reply, PositionsInAnotherUnitAreNotTakenForPulses) {
  EXPECT_FALSE(parse_positions(model(), *parse("Q:S", "U+1,U+2,U+3,1,1,1,R,R,R"), kAllAxes));
}

TEST(Reply, Identity) {
  const auto identity = parse_identity("SIGMAKOKI,SHRC-203,2106001001,V2.00.000");
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->vendor, "SIGMAKOKI");
  EXPECT_EQ(identity->model, "SHRC-203");
  EXPECT_EQ(identity->serial_number, "2106001001");
  EXPECT_EQ(identity->firmware, "V2.00.000");
  for (const char* line : {"", "SIGMAKOKI,SHRC-203,2106001001", "SIGMAKOKI,SHRC-203,,V2.00.000",
                           "SIGMAKOKI,SHRC-203,2106001001,V2.00.000,X", "SIGMAKOKI,SHRC-203,21A6001001,V2.00.000",
                           "OK,SHRC-203,2106001001,2.00"}) {
    EXPECT_FALSE(parse_identity(line)) << line;
  }
}

TEST(Reply, SpeedSettings) {
  const auto speed = parse_speed_setting("S100F1000R50");
  ASSERT_TRUE(speed);
  EXPECT_EQ(speed->minimum, 100);
  EXPECT_EQ(speed->maximum, 1000);
  EXPECT_EQ(speed->acceleration_ms, 50);
  for (const char* field : {"", "S100F1000", "S100R50F1000", "100F1000R50", "SF1000R50", "S1x0F1000R50", "S0F1000R50",
                            "S100F1000001R50", "S100F1000R0", "S100F1000R1001", "S100F-1000R50"}) {
    EXPECT_FALSE(parse_speed_setting(field)) << field;
  }
}

TEST(Reply, Integers) {
  EXPECT_EQ(parse_integer("+42"), 42);
  EXPECT_EQ(parse_integer("-999999999999999999"), -999'999'999'999'999'999);
  for (const char* text : {"", "+", "--1", "1.0", "1 ", "9999999999999999999"})
    EXPECT_FALSE(parse_integer(text)) << text;
}

}  // namespace
}  // namespace axisgate::shrc203::reply_test
