#include "tests/echo/text_check.h"

#include <string>

namespace axisgate::echo {

void TextCheck::feed(std::string_view bytes) {
  for (const char c : bytes) {
    if (c != '\n' && (c < ' ' || c > '~')) found("a byte that is no printable ASCII");
    if (line_.bytes == 0) line_.begin = next_;
    ++line_.bytes;
    if (c != '\n' && line_.bytes > kLongestLine) found("the line is longer than 80 bytes");
    if (line_.bytes > longest_.bytes) longest_ = line_;
    next_ = after(next_, c);
    if (c == '\n') line_ = {};
  }
}

void TextCheck::found(std::string_view text) {
  if (error_) {
    ++error_->more;
  } else {
    error_ = jobs::FoundError{next_, std::string(text), "lines"};
  }
}

std::vector<jobs::FoundWarning> TextCheck::warnings() const {
  if (line_.bytes == 0) return {};
  return {{"open-line", "end the last line with LF", line_.begin, "the last line has no LF"}};
}

}  // namespace axisgate::echo
