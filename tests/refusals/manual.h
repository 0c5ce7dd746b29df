// What the manual says of NG, command by command: typed by hand from its pages, not from the command table.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::refusals {

using Lines = std::vector<std::string>;

// Where a command works: the notes of manual 4. and 37), and the lists of 102), 111) and 117).
enum class Where { everywhere, asked_of_settings, host_and_program, host, program, editing, switches };

struct Sentence {
  int section = 0;
  std::string command;  // as the manual heads it: "M:"
  std::string line;     // as it is taken in the ordinary state
  // Of "In the case of Busy, the motor excitation is OFF or the limit sensor is detected, it will be NG" the letters B,
  // E and L.
  std::string ng = {};
  Where where = Where::host;
  Lines before = {}, after = {};  // what belongs about the line: what G: starts, and the G: itself
  Lines out_of_range = {};        // the same with a number that the manual does not allow
  std::string malformed = {};     // of another form than the manual's
  std::string third = {};         // naming axis 3, to a controller of axes 1 and 2
  bool moves = false;             // sets the stage moving, or makes it ready to

  bool says(char letter) const { return ng.find(letter) != std::string::npos; }
  // Ways in and out of the mode included.
  Lines way_there() const;
  Lines whole() const;
  Lines with(const std::string& line_instead) const;
};

// 1) to 136), in order.
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
