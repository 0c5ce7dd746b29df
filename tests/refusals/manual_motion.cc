// Manual 59) to 70), 85) to 94): origin returns, distances and targets of single axes, starts, speeds.
#include "tests/refusals/manual.h"

namespace axisgate::refusals {
namespace {

Sentence of_axes(int section, const std::string& command, const std::string& ng, bool moves) {
  return {.section = section,
          .command = command,
          .line = command + "1",
          .ng = ng,
          .out_of_range = {command + "4"},
          .malformed = command + "E",
          .third = command + "3",
          .moves = moves};
}

// Returns the sentence of a command with a distance or a target. `third` names axis 3, which this controller does not
// have.
Sentence way(int section, const std::string& command, const std::string& ng) {
  return {.section = section,
          .command = command,
          .line = command + "1+P1000",
          .ng = ng,
          .after = {"G:1"},
          .out_of_range = {command + "1+P1000000000", command + "4+P1000"},
          .malformed = command + "1+X1000",
          .third = command + "3+P1000",
          .moves = true};
}

// Returns lines with wrong speeds: spds and spdf are 1 to 1,000,000, "Please set it to the minimum speed (S) or
// higher", r is 1 to 1,000.
Lines wrong_speeds(const std::string& before) {
  return {before + "S0F1000R50", before + "S100F1000001R50", before + "S100F1000R0", before + "S100F1000R1001",
          before + "S2000F1000R50"};
}

Sentence prebuffer_way(int section, const std::string& command) {
  Sentence sentence = way(section, command, "E");
  for (const std::string& line : wrong_speeds(command + "1+P1000,")) sentence.out_of_range.push_back(line);
  return sentence;
}

Sentence three_speeds(int section, const std::string& command) {
  Sentence sentence{.section = section,
                    .command = command,
                    .line = command + "1S100F1000R100",
                    .ng = "B",
                    .out_of_range = wrong_speeds(command + "1"),
                    .malformed = command + "1S100F1000",
                    .third = command + "3S100F1000R100"};
  sentence.out_of_range.push_back(command + "4S100F1000R100");
  return sentence;
}

Sentence one_speed(int section, const std::string& command) {
  return {.section = section,
          .command = command,
          .line = command + "1F2000",
          .ng = "B",
          .out_of_range = {command + "1F0", command + "1F1000001", command + "4F2000"},
          .malformed = command + "1P2000",
          .third = command + "3F2000"};
}

}  // namespace

std::vector<Sentence> origin_and_ways() {
  Sentence origin = of_axes(59, "H:", "BE", true), origin_told = of_axes(60, "HRT:", "BE", true);
  origin.out_of_range.emplace_back("H5:1");
  origin_told.out_of_range.emplace_back("HRT5:1");
  return {
      origin,
      origin_told,
      of_axes(61, "Z:", "BE", true),
      of_axes(62, "ZRT:", "BE", true),
      of_axes(63, "R:", "BE", false),
      of_axes(64, "RC:", "BE", false),
      // "In the case of the motor excitation is OFF": Busy is not named.
      {.section = 65, .command = "L:", .line = "L:1", .ng = "E", .out_of_range = {"L:4"}, .malformed = "L:X"},
      {.section = 66, .command = "L:E", .line = "L:E", .where = Where::host_and_program, .malformed = "L:E1"},
      way(67, "M:", "BE"),
      prebuffer_way(68, "MP:"),
      way(69, "A:", "BE"),
      prebuffer_way(70, "AP:"),
  };
}

std::vector<Sentence> starts_and_speeds() {
  return {
      {.section = 85, .command = "G", .line = "G", .ng = "BE", .before = {"M:1+P1000"}, .moves = true},
      {.section = 86,
       .command = "G:",
       .line = "G:1",
       .ng = "BE",
       .before = {"M:1+P1000"},
       .out_of_range = {"G:4"},
       .malformed = "G:E",
       .third = "G:3",
       .moves = true},
      of_axes(87, "GC:", "BE", false),
      {.section = 88,
       .command = "J:",
       .line = "J:1+",
       .ng = "BE",
       .out_of_range = {"J:4+"},
       .malformed = "J:1*",
       .moves = true},
      three_speeds(89, "D:"),
      one_speed(90, "DS:"),
      one_speed(91, "DF:"),
      {.section = 92,
       .command = "DR:",
       .line = "DR:1 50",
       .ng = "B",
       .out_of_range = {"DR:1 0", "DR:1 1001", "DR:4 50"},
       .malformed = "DR:1",
       .third = "DR:3 50"},
      // "It can be used only during operation with the "J:" command."
      {.section = 93,
       .command = "JD:",
       .line = "JD:1F1000",
       .before = {"J:1+", "G:1"},
       .out_of_range = {"JD:1F0", "JD:1F1000001", "JD:4F1000"},
       .malformed = "JD:1P1000"},
      three_speeds(94, "B:"),
  };
}

}  // namespace axisgate::refusals
