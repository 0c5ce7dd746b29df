// Manual 45) to 58), 95) to 101): settings, which begin no motion.
#include "tests/refusals/manual.h"

namespace axisgate::refusals {
namespace {

// Returns sections 45) to 50).
std::vector<Sentence> of_controller() {
  return {
      {.section = 45,
       .command = "PSET:",
       .line = "PSET:1+P1000",
       .ng = "B",
       .out_of_range = {"PSET:1+P1000000000", "PSET:4+P1000"},
       .malformed = "PSET:1+X1000",
       .third = "PSET:3+P1000"},
      {.section = 46, .command = "RESET:", .line = "RESET:", .malformed = "RESET:1"},
      {.section = 47,
       .command = "SLEEP:",
       .line = "SLEEP:1",
       .ng = "B",
       .out_of_range = {"SLEEP:2"},
       .malformed = "SLEEP:"},
      {.section = 48, .command = "BO:", .line = "BO:1", .ng = "B", .out_of_range = {"BO:2"}, .malformed = "BO:"},
      {.section = 49,
       .command = "MODE:",
       .line = "MODE:MANUAL",
       .ng = "B",
       .where = Where::everywhere,
       .malformed = "MODE:PLAY"},
      {.section = 50, .command = "FMT:", .line = "FMT:HIT", .ng = "B", .malformed = "FMT:FC"},
  };
}

// Returns sections 51) to 58).
std::vector<Sentence> of_axes() {
  return {
      {.section = 51,
       .command = "F:",
       .line = "F:10",
       .ng = "B",
       .out_of_range = {"F:12", "F:40"},
       .malformed = "F:1",
       .third = "F:30"},
      {.section = 52,
       .command = "C:",
       .line = "C:11",
       .ng = "B",
       .out_of_range = {"C:12", "C:40"},
       .malformed = "C:1",
       .third = "C:31"},
      {.section = 53,
       .command = "BEC:",
       .line = "BEC:1",
       .where = Where::host_and_program,
       .out_of_range = {"BEC:4"},
       .malformed = "BEC:E",
       .third = "BEC:3"},
      {.section = 54,
       .command = "BEEP:",
       .line = "BEEP:0",
       .ng = "B",
       .out_of_range = {"BEEP:2"},
       .malformed = "BEEP:"},
      // "If the number of divisions is other than the above, a command error will occur."
      {.section = 55,
       .command = "S:",
       .line = "S:1,100",
       .ng = "B",
       .out_of_range = {"S:1,7", "S:1,15", "S:1,0", "S:4,100"},
       .malformed = "S:1100",
       .third = "S:3,100"},
      {.section = 56, .command = "W:", .line = "W:255", .ng = "B", .out_of_range = {"W:2551"}, .malformed = "W:"},
      // Sections 57) and 58) name no condition: a wait is a setting of the prebuffer, which G: starts.
      {.section = 57,
       .command = "WT:",
       .line = "WT:1,1",
       .after = {"G:1"},
       .out_of_range = {"WT:1,2551", "WT:4,1"},
       .malformed = "WT:1",
       .third = "WT:3,1"},
      {.section = 58,
       .command = "WI:",
       .line = "WI:1,0",
       .after = {"G:1"},
       .out_of_range = {"WI:1,64", "WI:4,1"},
       .malformed = "WI:1",
       .third = "WI:3,1"},
  };
}

}  // namespace

std::vector<Sentence> settings() {
  std::vector<Sentence> all = of_controller();
  for (Sentence& one : of_axes()) all.push_back(std::move(one));
  return all;
}

std::vector<Sentence> inputs_and_triggers() {
  return {
      {.section = 95, .command = "I:", .line = "I:", .malformed = "I:1"},
      {.section = 96, .command = "O:", .line = "O:32", .out_of_range = {"O:64"}, .malformed = "O:"},
      {.section = 97,
       .command = "T:T",
       .line = "T:T100",
       .ng = "B",
       .out_of_range = {"T:T0", "T:T10001"},
       .malformed = "T:T"},
      {.section = 98,
       .command = "T:P",
       .line = "T:P2P5",
       .ng = "B",
       .out_of_range = {"T:P2P1", "T:P2P30001", "T:P4P5"},
       .malformed = "T:P2"},
      {.section = 99, .command = "T:S", .line = "T:S", .ng = "B", .malformed = "T:S1"},
      {.section = 100, .command = "T:M", .line = "T:M", .ng = "B", .malformed = "T:M1"},
      {.section = 101,
       .command = "T:E",
       .line = "T:E1P+2",
       .ng = "B",
       .out_of_range = {"T:E1P+1", "T:E1P+30001", "T:E4P+2"},
       .malformed = "T:E1"},
  };
}

}  // namespace axisgate::refusals
