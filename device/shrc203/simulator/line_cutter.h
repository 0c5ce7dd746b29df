// Cuts what a host sends into lines, keeping the bytes that make a line bad (manual 3: NG_I).
#pragma once

#include <optional>
#include <string>

namespace axisgate::shrc203::simulator {

class LineCutter {
 public:
  // Longer than any command of the manual; what comes beyond it is not kept.
  static constexpr std::size_t kBytesMax = 512;

  struct Line {
    std::string text;       // without blanks around it
    bool overlong = false;  // cut
    bool bad_byte = false;  // NULL or non-ASCII in it
  };

  // CR, LF and CR LF end a line. A line without anything in it is none.
  std::optional<Line> push(char byte);
  void clear() { line_ = {}; }

 private:
  Line line_;
};

}  // namespace axisgate::shrc203::simulator
