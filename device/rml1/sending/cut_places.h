// Places at which a job may be cut. Numbers are never cut: if an abort came between the two parts of a number, the mill
// would execute a different number.
#pragma once

#include <cstddef>
#include <string>

namespace axisgate::rml1 {

// A SetReader finds the ends of the sets in a list of coordinates. Two commands may follow each other without a
// delimiter, and a blank may separate two numbers (guideline 2-2, 2-3).
class SetReader {
 public:
  // Takes the next byte. Reports whether it is a comma that follows a complete set. Call end() after each terminator.
  bool take(char c);
  void end() { numbers_ = 0; }

 private:
  void take_name(char c);
  void take_number(char c);

  static constexpr std::size_t kLongestName = 3;
  std::string name_;
  std::size_t numbers_ = 0;  // how many numbers make a set; 0: the command has no list that can be cut
  std::size_t count_ = 0;    // how many numbers of the command were read
  bool in_number_ = false, has_point_ = false;
};

// CutPlaces finds the places at which a job may be cut. It must take all bytes of the job, from the first one.
class CutPlaces {
 public:
  enum class Cut {
    no,
    in_list,          // after the comma of a complete set of coordinates
    between_commands  // after a terminator, or after a delimiter that follows the terminator
  };
  // Takes the next byte of the job. Returns the kind of cut that is possible after it.
  Cut take(char c);

 private:
  SetReader sets_;
  bool ended_ = true;   // the last command is complete
  bool calls_ = false;  // a circumflex applies to the next command, even if delimiters follow it (guideline 1-2)
};

}  // namespace axisgate::rml1
