// Errors that the panel shows.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace axisgate::rml1::simulator {

class Display {
 public:
  // Shows an error of a command, 1 to 3 (guideline 2, 3). Each number is shown once, in the order of occurrence.
  void command_error(int number);
  // Shows an error of communication, 10 to 18. The first is kept, later ones are ignored (guideline 4-1, "Multiple
  // Errors").
  void line_error(int number);

  void clear_command_errors() { command_errors_.clear(); }  // H (guideline 3-1)
  void clear();                                             // IN (guideline 3-2)

  std::string text() const;  // "1,3,16", "none"

 private:
  std::vector<int> command_errors_;
  std::optional<int> line_error_;
};

}  // namespace axisgate::rml1::simulator
