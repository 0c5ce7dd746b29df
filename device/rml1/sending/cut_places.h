// Behind which bytes a job may be cut: a number that is cut in two would be executed as another one, if an abort came
// between.
#pragma once

#include <cstddef>
#include <string>

namespace axisgate::rml1 {

// Where a set of a list is complete. A command may follow another without a delimiter, and a blank may divide numbers
// (guideline 2-2, 2-3).
class SetReader {
 public:
  // Whether this is the comma behind a complete set. A command is over with its terminator: then end() is called.
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
    in_list,          // behind the comma of a complete set of coordinates
    between_commands  // behind a terminator, or another delimiter behind one
  };
  // What a cut behind this byte is.
  Cut take(char c);

 private:
  SetReader sets_;
  bool ended_ = true;   // no command is open
  bool calls_ = false;  // a circumflex waits for the next command, across delimiters (guideline 1-2)
};

}  // namespace axisgate::rml1
