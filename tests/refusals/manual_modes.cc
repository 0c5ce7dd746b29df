// Manual 102) to 136): programs, memory switches, saved positions.
#include "tests/refusals/manual.h"

namespace axisgate::refusals {
namespace {

Sentence of_program(int section, const std::string& line, const std::string& ng = "B") {
  return {
      .section = section, .command = line, .line = line, .ng = ng, .where = Where::program, .malformed = line + "X"};
}

Sentence of_switches(int section, const std::string& command, const std::string& values, Lines wrong) {
  return {.section = section,
          .command = command,
          .line = command + values,
          .where = Where::switches,
          .out_of_range = std::move(wrong),
          .malformed = command};
}

Sentence of_position(int section, const std::string& command, const std::string& ng, bool moves) {
  return {.section = section,
          .command = command,
          .line = command + ",1",
          .ng = ng,
          .out_of_range = {command + ",0", command + ",21"},
          .malformed = command,
          .moves = moves};
}

// Returns sections 102) to 110).
std::vector<Sentence> running() {
  return {
      {.section = 102, .command = "P:R", .line = "P:R", .ng = "B", .after = {"P:H"}, .malformed = "P:R1"},
      {.section = 103,
       .command = "P:H",
       .line = "P:H",
       .ng = "B",
       .where = Where::program,
       .before = {"P:R"},
       .malformed = "P:H1"},
      {.section = 104,
       .command = "P:P",
       .line = "P:P2",
       .ng = "B",
       .where = Where::program,
       .out_of_range = {"P:P0", "P:P9"},
       .malformed = "P:P"},
      of_program(105, "P:S"),
      // A pause follows the single line, and P:H is NG during a pause.
      {.section = 106,
       .command = "P:O",
       .line = "P:O",
       .ng = "B",
       .where = Where::program,
       .after = {"P:E", "P:H"},
       .malformed = "P:OX"},
      // Sections 107) and 108) say "OK or NG" and name no condition.
      of_program(107, "P:E", ""),
      {.section = 108,
       .command = "P:U",
       .line = "P:U0",
       .where = Where::program,
       .out_of_range = {"P:U2"},
       .malformed = "P:U"},
      {.section = 109,
       .command = "P:C",
       .line = "P:C0",
       .ng = "B",
       .where = Where::program,
       .out_of_range = {"P:C2"},
       .malformed = "P:C"},
      {.section = 110,
       .command = "P:T",
       .line = "P:T0",
       .ng = "B",
       .where = Where::program,
       .out_of_range = {"P:T2"},
       .malformed = "P:T"},
  };
}

// Returns sections 111) to 116).
std::vector<Sentence> editing() {
  return {
      {.section = 111,
       .command = "P:ON",
       .line = "P:ON",
       .ng = "B",
       .where = Where::program,
       .before = {"P:R"},
       .after = {"P:OFF", "P:H"},
       .malformed = "P:ON1"},
      {.section = 112,
       .command = "P:OFF",
       .line = "P:OFF",
       .ng = "B",
       .where = Where::editing,
       .before = {"P:R", "P:ON"},
       .after = {"P:H"},
       .malformed = "P:OFF1"},
      {.section = 113,
       .command = "P:DEL",
       .line = "P:DEL,1500",
       .ng = "B",
       .where = Where::editing,
       .out_of_range = {"P:DEL,0", "P:DEL,4001"},
       .malformed = "P:DEL"},
      {.section = 114,
       .command = "P:SET",
       .line = "P:SET,1500,M,1,1,1,100,200,300,0,1,0,0,1,100",
       .ng = "B",
       .where = Where::editing,
       .out_of_range = {"P:SET,0,END", "P:SET,4001,END"},
       .malformed = "P:SET,1500"},
      {.section = 115,
       .command = "P:GET",
       .line = "P:GET,1500",
       .ng = "B",
       .where = Where::editing,
       .out_of_range = {"P:GET,0", "P:GET,4001"},
       .malformed = "P:GET"},
      {.section = 116,
       .command = "P:INIT",
       .line = "P:INIT",
       .ng = "B",
       .where = Where::editing,
       .malformed = "P:INIT1"},
  };
}

}  // namespace

std::vector<Sentence> programs() {
  std::vector<Sentence> all = running();
  for (Sentence& one : editing()) all.push_back(std::move(one));
  return all;
}

std::vector<Sentence> memory_switches() {
  return {
      {.section = 117, .command = "MS:ON", .line = "MS:ON", .ng = "B", .after = {"MS:OFF"}, .malformed = "MS:ON1"},
      {.section = 118,
       .command = "MS:OFF",
       .line = "MS:OFF",
       .where = Where::switches,
       .before = {"MS:ON"},
       .malformed = "MS:OFF1"},
      of_switches(119, "MS:SET", ",0,1,1", {"MS:SET,9,1,1"}),
      of_switches(120, "MS:GET", ",0,1", {"MS:GET,9,1"}),
      of_switches(121, "MS:DEF", ",0,1", {"MS:DEF,9,1"}),
      of_switches(122, "MS:DEFR", ",0,0", {"MS:DEFR,9,0"}),
      of_switches(123, "MS:SETK", ",0,6,0,1,1,0,1,0,0,0", {"MS:SETK,9,6"}),
      of_switches(124, "MS:GETK", ",0", {"MS:GETK,9"}),
      of_switches(125, "MS:DEFK", ",0", {"MS:DEFK,9"}),
      of_switches(126, "MS:DEFRK", ",0", {"MS:DEFRK,9"}),
  };
}

std::vector<Sentence> saved_positions() {
  return {
      of_position(127, "PIT:DEL", "B", false), of_position(128, "PIT:SET", "B", false),
      of_position(129, "PIT:GET", "", false),  of_position(130, "PIT:G", "BE", true),
      of_position(131, "PIT:GRT", "BE", true), of_position(132, "PAV:DEL", "B", false),
      of_position(133, "PAV:SET", "B", false), of_position(134, "PAV:GET", "", false),
      of_position(135, "PAV:G", "BE", true),   of_position(136, "PAV:GRT", "BE", true),
  };
}

}  // namespace axisgate::refusals
