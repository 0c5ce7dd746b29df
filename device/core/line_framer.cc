#include "device/core/line_framer.h"

#include <utility>

#include "device/core/guard.h"

namespace axisgate {
namespace {

bool is_padding(char byte) { return byte == '\0' || byte == ' '; }

}  // namespace

void LineFramer::push(std::string_view bytes) {
  for (const char byte : bytes) {
    if (byte == '\r' || byte == '\n') {
      end_line();
    } else if (partial_.empty() && is_padding(byte)) {
      continue;
    } else if (partial_.size() < kLineBytesMax) {
      partial_.push_back(byte);
    } else if (!is_padding(byte)) {
      overlong_ = true;
    }
  }
}

void LineFramer::end_line() {
  while (!partial_.empty() && is_padding(partial_.back())) partial_.pop_back();
  const bool room = ready_.size() < kLinesMax || !guarded(Guard::unread_lines_bounded);
  if (!partial_.empty() && room) ready_.push_back({std::move(partial_), overlong_});
  partial_.clear();
  overlong_ = false;
}

std::optional<LineFramer::Line> LineFramer::next() {
  if (ready_.empty()) return std::nullopt;
  Line line = std::move(ready_.front());
  ready_.pop_front();
  return line;
}

void LineFramer::clear() {
  partial_.clear();
  overlong_ = false;
  ready_.clear();
}

}  // namespace axisgate
