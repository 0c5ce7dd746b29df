// Cuts a byte stream into lines. An incomplete line never comes out, so it never parses as a complete one.
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
  static constexpr std::size_t kLinesMax = 1024;  // unread lines kept; more are dropped, newest first

  struct Line {
    std::string text;
    bool overlong = false;  // cut to kLineBytesMax: not to be parsed
  };

  // CR, LF and CR LF each end a line; empty lines vanish; NUL and blanks around a line are padding that some
  // interfaces add, and are stripped.
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
