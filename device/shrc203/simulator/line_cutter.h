// Cuts the host's bytes into lines, and notes bytes that make a line bad (manual 3: NG_I).
#pragma once

#include <optional>
#include <string>

namespace axisgate::shrc203::simulator {

class LineCutter {
 public:
  // Longer than any command of the manual; further bytes of a line are not kept.
  static constexpr std::size_t kBytesMax = 512;

  struct Line {
    std::string text;       // without surrounding blanks
    bool overlong = false;  // the line was cut
    bool bad_byte = false;  // it contains NULL or a non-ASCII byte
  };

  // Returns the line that this byte ends, if any. CR, LF and CR LF end a line. An empty line is ignored.
  std::optional<Line> push(char byte);
  void clear() { line_ = {}; }

 private:
  Line line_;
};

}  // namespace axisgate::shrc203::simulator
