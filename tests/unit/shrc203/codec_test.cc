// Lines as callers write them and as they are sent; the examples are from the manual.
#include <gtest/gtest.h>

#include <string>

#include "device/shot/command/command.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203::codec_test {
namespace {

std::string sent(std::string_view written) {
  const auto command = model().parse(written);
  return command ? command->line : "refused: " + std::string(name(command.error().reason));
}

std::string row(std::string_view written) {
  const auto command = model().parse(written);
  return command ? std::string(command->row->name) : "refused: " + std::string(name(command.error().reason));
}

TEST(Codec, TheManualsExamplesAreSentAsTheyStand) {
  for (const char* line : {"M:1+P1000",
                           "M:A+P1000+P2000",
                           "M:B+P1000+P3000",
                           "M:W+P1000+P2000+P3000",
                           "M:W+U10+N5+M50",
                           "A:1+P1000",
                           "MP:1+P1000",
                           "K:A+P1000+P200",
                           "K:D+U1000+P200+M0.3",
                           "D:1S100F1000R100",
                           "D:AS100F1000R100 S200F2000R200",
                           "HRT:1",
                           "HRT:",
                           "H:W",
                           "ZRT:W",
                           "G",
                           "G:1",
                           "G:W",
                           "G:",
                           "GC:A",
                           "L:1",
                           "L:W",
                           "L:E",
                           "C:10",
                           "C:A0",
                           "C:W0",
                           "BEC:A",
                           "?:V",
                           "?:N",
                           "?:M1,M",
                           "?:MPA",
                           "?:CW",
                           "Q:SM",
                           "Q:SUC",
                           "SRQ:AS",
                           "SRQ:",
                           "!:",
                           "*IDN?"}) {
    EXPECT_EQ(sent(line), line);
  }
}

// Manual 68), 70), 84): the examples have blanks after the comma before the speeds.
TEST(Codec, BlanksAfterACommaAreLeftOut) {
  EXPECT_EQ(sent("MP:1+P1000, S100F1000R50"), "MP:1+P1000,S100F1000R50");
  EXPECT_EQ(sent("MP:A+P1000+P2000, S100F1000R50 S200F2000R100"), "MP:A+P1000+P2000,S100F1000R50 S200F2000R100");
}

TEST(Codec, CaseSignAndUnitMayBeOmitted) {
  EXPECT_EQ(sent("m:1+p1000"), "M:1+P1000");
  EXPECT_EQ(sent("A:1+1000"), "A:1+P1000");
  EXPECT_EQ(sent("A:1-1000"), "A:1-P1000");
  EXPECT_EQ(sent("A:1U100.0"), "A:1+U100.0");
  EXPECT_EQ(sent("M:a+1000-2000"), "M:A+P1000-P2000");
  EXPECT_EQ(sent("q:s"), "Q:S");
}

TEST(Codec, RowsThatLookAlikeAreToldApart) {
  EXPECT_EQ(row("G"), "G");
  EXPECT_EQ(row("G:"), "G:");
  EXPECT_EQ(row("L:"), "L:");
  EXPECT_EQ(row("L:E"), "L:E");
  EXPECT_EQ(row("?:A"), "?:A");
  EXPECT_EQ(row("?:AA"), "?:A");
  EXPECT_EQ(row("?:AP"), "?:AP");
  EXPECT_EQ(row("?:AP1"), "?:AP");
  EXPECT_EQ(row("?:MP1,U"), "?:MP");
  EXPECT_EQ(row("?:EP"), "?:EP");
  EXPECT_EQ(row("?:W"), "?:W");
  EXPECT_EQ(row("?:WT1"), "?:WT");
  EXPECT_EQ(row("!:AS"), "!:S");
  EXPECT_EQ(row("Q:S"), "Q:S");
}

TEST(Codec, AxesOfALine) {
  const AxisSet two = AxisSet::of(1) | AxisSet::of(2);
  EXPECT_EQ(model().parse("G:A")->axes(kAllAxes), two);
  EXPECT_EQ(model().parse("G:W")->axes(two), two);
  EXPECT_EQ(model().parse("G:")->axes(two), two);
  EXPECT_EQ(model().parse("G")->axes(two), two);
  EXPECT_EQ(model().parse("C:30")->axes(kAllAxes), AxisSet::of(3));
}

TEST(Codec, OutOfRange) {
  EXPECT_EQ(sent("M:1+P999999999"), "M:1+P999999999");
  EXPECT_EQ(sent("M:1+P1000000000"), "refused: OUT_OF_RANGE");
  EXPECT_EQ(sent("M:1+P1.5"), "refused: OUT_OF_RANGE");
  EXPECT_EQ(sent("D:1S1F1000000R1000"), "D:1S1F1000000R1000");
  EXPECT_EQ(sent("D:1S0F1000R100"), "refused: OUT_OF_RANGE");
  EXPECT_EQ(sent("D:1S1F1000001R100"), "refused: OUT_OF_RANGE");
  EXPECT_EQ(sent("D:1S1F1000R1001"), "refused: OUT_OF_RANGE");
  EXPECT_EQ(sent("D:1S2000F1000R100"), "refused: OUT_OF_RANGE") << "S above F";
}

TEST(Codec, NotOfAnyShape) {
  for (const char* line : {"X:1", "?:", " G", "GO"}) {
    EXPECT_EQ(sent(line), "refused: UNKNOWN_COMMAND") << line;
  }
}

// The controller has these commands, but with other parameters.
TEST(Codec, NotOfItsShape) {
  for (const char* line : {"M:1", "M:A+P1000", "M:1+P1000+P2000", "M:1+Q1000", "C:1", "C:12x", "K:1+P1000", "G:E",
                           "D:AS100F1000R100", "M:1+P1000 ", "G:1 G:2"}) {
    EXPECT_EQ(sent(line), "refused: MALFORMED_LINE") << line;
  }
}

// Numbers that are not among the permitted values.
TEST(Codec, NoneOfTheChoices) {
  for (const char* line : {"M:4+P1000", "?:R4", "C:12", "S:1,7", "S:1,15", "WI:1,64", "H5:1", "T:P4P5"}) {
    EXPECT_EQ(sent(line), "refused: OUT_OF_RANGE") << line;
  }
}

// One request is one line: characters that could end the line or begin another are never sent.
TEST(Codec, CharactersThatAreNeverSent) {
  EXPECT_EQ(sent(""), "refused: MALFORMED_LINE");
  EXPECT_EQ(sent("G:1\r"), "refused: MALFORMED_LINE");
  EXPECT_EQ(sent("G:1\nG:2"), "refused: MALFORMED_LINE");
  EXPECT_EQ(sent(std::string_view("G:1\0", 4)), "refused: MALFORMED_LINE");
  EXPECT_EQ(sent("G:1\t"), "refused: MALFORMED_LINE");
  EXPECT_EQ(sent("G:\x7F"), "refused: MALFORMED_LINE");
  EXPECT_EQ(sent("M:1+\xC2\xB5"
                 "10"),
            "refused: MALFORMED_LINE");
  EXPECT_EQ(sent(std::string(201, 'G')), "refused: MALFORMED_LINE");
  EXPECT_EQ(sent(std::string(200, 'G')), "refused: UNKNOWN_COMMAND");
}

TEST(Codec, CommandsOfOurOwnMaking) {
  const AxisSet two = AxisSet::of(1) | AxisSet::of(3);
  EXPECT_EQ(model().make("G:", two).line, "G:B");
  EXPECT_EQ(model().make("GC:", kAllAxes).line, "GC:D");
  EXPECT_EQ(model().make("MP:", Arguments().axes(two).pulses(-5).pulses(70).speeds(1, 2, 3).speeds(4, 5, 6)).line,
            "MP:B-P5+P70,S1F2R3 S4F5R6");
  EXPECT_EQ(model().make("KP:", Arguments().axes(two).pulses(0).pulses(-999999999).speeds(10, 20, 30)).line,
            "KP:B+P0-P999999999,S10F20R30");
  EXPECT_EQ(model().make("Q:S", Arguments().add("u", "P").add("c", "C")).line, "Q:SPC");
}

TEST(Codec, ArgumentsThatDoNotFit) {
  const auto reason = [](const CommandRow& into, const Arguments& arguments) {
    const auto line = encode(into, arguments);
    return line ? Reason::unspecified : line.error().reason;
  };
  const CommandRow& move = model().row("M:");
  EXPECT_EQ(reason(move, Arguments().axes(AxisSet::of(1))), Reason::invalid_request);
  EXPECT_EQ(reason(move, Arguments().axes(kAllAxes).pulses(1)), Reason::invalid_request);
  EXPECT_EQ(reason(move, Arguments().axes(AxisSet::of(1)).pulses(1).pulses(2)), Reason::invalid_request);
  EXPECT_EQ(reason(move, Arguments().axes(AxisSet::of(1)).pulses(1'000'000'000)), Reason::out_of_range);
  EXPECT_EQ(reason(model().row("K:"), Arguments().axes(AxisSet::of(1)).pulses(1)), Reason::out_of_range);
}

// The manual's tables use these forms without a sign or a unit (manual 71), 77), 78), 90)).
TEST(Codec, LooseFormsOfArcsAndSpeeds) {
  EXPECT_EQ(model().parse("E:0A0M0.05-M0.05")->line, "E:0A0+M0.05-M0.05");
  EXPECT_EQ(model().parse("EP:0A0M0.05-M0.05,S0.5F5R50")->line, "EP:0A0+M0.05-M0.05,S0.5F5R50");
  EXPECT_EQ(model().parse("EP:1B0+P100-200D90,S100F1000R50")->line, "EP:1B0+P100-P200D90,S100F1000R50");
  EXPECT_EQ(model().parse("E:0A0100-200")->line, "E:0A0+P100-P200");
  EXPECT_EQ(model().parse("DS:A100 200").has_value(), false);
  EXPECT_EQ(model().parse("DS:2100")->line, "DS:2F100");
}

// Angles are above 0 and at most 360, with or without a fraction, whatever the unit of the coordinates (manual 72)).
TEST(Codec, AnglesHaveTheirOwnRange) {
  EXPECT_EQ(model().parse("E:1A0+P100-P200D22.5")->line, "E:1A0+P100-P200D22.5");
  EXPECT_EQ(model().parse("E:1A0+M1-M2D360")->line, "E:1A0+M1-M2D360");
  for (const char* line :
       {"E:1A0+P100-P200D0", "E:1A0+M1-M2D0.0", "E:1A0+M1-M2D360.01", "E:1A0+P1-P2D361", "E:4A0+P1-P2D360000.5+P1"}) {
    ASSERT_FALSE(model().parse(line)) << line;
    EXPECT_EQ(model().parse(line).error().reason, Reason::out_of_range) << line;
  }
}

// A helix also moves axis 3 (manual 74)), and the parameter a of T:T is a time (manual 97)).
TEST(Codec, AxesThatALetterDoesNotName) {
  EXPECT_EQ(model().parse("E:3A0N2+P1-P2+P3")->axes(kAllAxes), kAllAxes);
  EXPECT_EQ(model().parse("E:0A0+P1-P2")->axes(kAllAxes).count(), 2);
  EXPECT_EQ(model().parse("T:T100")->axes(kAllAxes), kAllAxes);
}

}  // namespace
}  // namespace axisgate::shrc203::codec_test
