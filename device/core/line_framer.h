// Cuts a byte stream into lines. An incomplete line is never returned, so it never parses as a complete one.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate {

class LineFramer {
 public:
  static constexpr std::size_t kLineBytesMax = 256;
  static constexpr std::size_t kLinesMax = 1024;  // maximum number of unread lines; further lines are dropped

  struct Line {
    std::string text;
    bool overlong = false;  // cut to kLineBytesMax: not to be parsed
  };

  // Adds bytes. CR, LF and CR LF each end a line, and empty lines are dropped. NUL and blanks around a line are padding
  // that some interfaces add, and are removed.
  void push(std::string_view bytes);

  std::optional<Line> next();
  bool mid_line() const { return !partial_.empty(); }
  void clear();

 private:
  void end_line();

  std::string partial_;
  bool overlong_ = false;
  std::deque<Line> ready_;
};

}  // namespace axisgate
