// Manual 1) to 44): questions. Their only conditions are the modes in which they work: the notes of 4. and 37), the
// lists of 102), 111), 117).
#include "tests/refusals/manual.h"

namespace axisgate::refusals {
namespace {

// Returns the sentence of a question about axes. The axis setting a is 1, 2, 3, A, B, C, D or W.
Sentence of_axes(int section, const std::string& line, const std::string& unit = {}) {
  return {.section = section,
          .command = line,
          .line = line,
          .where = Where::asked_of_settings,
          .out_of_range = {line + "4"},
          .malformed = unit.empty() ? line + "E" : line + "1,E",
          .third = line + "3"};
}

Sentence of_controller(int section, const std::string& line) {
  return {
      .section = section, .command = line, .line = line, .where = Where::asked_of_settings, .malformed = line + "X"};
}

Sentence of_status(int section, const std::string& command, const std::string& line) {
  return {.section = section,
          .command = command,
          .line = line,
          .where = Where::host_and_program,
          .malformed = command + "X"};
}

Sentence everywhere(int section, const std::string& line) {
  return {.section = section, .command = line, .line = line, .where = Where::everywhere, .malformed = line + "X"};
}

}  // namespace

std::vector<Sentence> questions() {
  const std::string unit = "u";
  return {
      everywhere(1, "*IDN?"),
      of_status(2, "!:", "!:"),
      {.section = 3,
       .command = "!:S",
       .line = "!:S",
       .where = Where::host_and_program,
       .out_of_range = {"!:4S"},
       .malformed = "!:SX",
       .third = "!:3S"},
      of_status(4, "Q:", "Q:"),
      of_status(5, "Q:S", "Q:SPC"),
      of_status(6, "SRQ:", "SRQ:"),
      {.section = 7,
       .command = "SRQ:S",
       .line = "SRQ:S",
       .where = Where::host_and_program,
       .out_of_range = {"SRQ:4S"},
       .malformed = "SRQ:SX",
       .third = "SRQ:3S"},
      of_controller(8, "?:V"),
      of_axes(9, "?:R"),
      of_axes(10, "?:P"),
      of_axes(11, "?:S"),
      of_axes(12, "?:AN"),
      of_axes(13, "?:D"),
      of_axes(14, "?:DS", unit),
      of_axes(15, "?:DF", unit),
      of_axes(16, "?:DR"),
      of_axes(17, "?:B"),
      of_axes(18, "?:M", unit),
      of_axes(19, "?:MP", unit),
      of_axes(20, "?:A", unit),
      of_axes(21, "?:AP", unit),
      of_controller(22, "?:E"),
      of_controller(23, "?:EP"),
      of_controller(24, "?:K"),
      of_controller(25, "?:KP"),
      of_controller(26, "?:O"),
      of_controller(27, "?:W"),
      of_axes(28, "?:WT"),
      of_axes(29, "?:WI"),
      of_controller(30, "?:N"),
      of_axes(31, "?:J"),
      of_axes(32, "?:ACS"),
      of_axes(33, "?:C"),
      of_axes(34, "?:F"),
      of_controller(35, "?:SLEEP"),
      of_controller(36, "?:BO"),
      everywhere(37, "?:MODE"),
      of_controller(38, "?:FMT"),
      of_controller(39, "?:BEEP"),
      everywhere(40, "?:CMD"),
      of_controller(41, "?:L"),
      of_controller(42, "?:T"),
      of_controller(43, "?:SN"),
      of_controller(44, "?:AXIS"),
  };
}

}  // namespace axisgate::refusals
