// The manual's sentences about NG for each command, typed by hand from its pages, not taken from the command table.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::refusals {

using Lines = std::vector<std::string>;

// Modes in which a command works, from the notes of manual 4. and 37), and the lists of 102), 111) and 117).
enum class Where { everywhere, asked_of_settings, host_and_program, host, program, editing, switches };

struct Sentence {
  int section = 0;
  std::string command;  // heading in the manual: "M:"
  std::string line;     // valid line, accepted in the ordinary state
  // Letters B, E and L for the conditions in "In the case of Busy, the motor excitation is OFF or the limit sensor is
  // detected, it will be NG".
  std::string ng = {};
  Where where = Where::host;
  Lines before = {}, after = {};  // lines around it: the setpoint that G: starts, or the G: itself
  Lines out_of_range = {};        // lines with a number that the manual does not allow
  std::string malformed = {};     // line whose form differs from the manual's
  std::string third = {};         // line with axis 3, for a controller of axes 1 and 2
  bool moves = false;             // moves the stage, or prepares a motion

  bool says(char letter) const { return ng.find(letter) != std::string::npos; }
  // The following functions include the lines that enter and leave the mode.
  Lines way_there() const;
  Lines whole() const;
  Lines with(const std::string& line_instead) const;
};

// Returns the sentences of sections 1) to 136), in order.
std::span<const Sentence> sentences();
const Sentence& sentence(std::string_view command);

std::vector<Sentence> questions();            // 1) to 44)
std::vector<Sentence> settings();             // 45) to 58)
std::vector<Sentence> origin_and_ways();      // 59) to 70)
std::vector<Sentence> interpolations();       // 71) to 84)
std::vector<Sentence> starts_and_speeds();    // 85) to 94)
std::vector<Sentence> inputs_and_triggers();  // 95) to 101)
std::vector<Sentence> programs();             // 102) to 116)
std::vector<Sentence> memory_switches();      // 117) to 126)
std::vector<Sentence> saved_positions();      // 127) to 136)

}  // namespace axisgate::refusals
