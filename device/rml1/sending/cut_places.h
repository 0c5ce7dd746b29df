// Places at which a job may be cut. A number that is cut in two would be executed as another number if an abort came
// between.
#pragma once

#include <cstddef>
#include <string>

namespace axisgate::rml1 {

// A SetReader finds the ends of the sets in a list of coordinates. A command may follow another without a delimiter,
// and a blank may divide numbers (guideline 2-2, 2-3).
class SetReader {
 public:
  // Reports whether this comma follows a complete set. The terminator ends the command through end().
  bool take(char c);
  void end() { numbers_ = 0; }

 private:
  void take_name(char c);
  void take_number(char c);

  static constexpr std::size_t kLongestName = 3;
  std::string name_;
  std::size_t numbers_ = 0;  // of a set of the list; 0: it is none
  std::size_t count_ = 0;
  bool in_number_ = false, has_point_ = false;
};

// Takes a job from its first byte on.
class CutPlaces {
 public:
  enum class Cut {
    no,
    in_list,          // after the comma of a complete set of coordinates
    between_commands  // after a terminator, or another delimiter after it
  };
  // Returns the kind of a cut after this byte.
  Cut take(char c);

 private:
  SetReader sets_;
  bool ended_ = true;   // no command is open
  bool calls_ = false;  // a circumflex waits for the next command, across delimiters (guideline 1-2)
};

}  // namespace axisgate::rml1
