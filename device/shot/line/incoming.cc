#include "device/shot/line/incoming.h"

#include "device/core/guard.h"
#include "device/shot/limits.h"

namespace axisgate::shot {

void Incoming::push(std::string_view bytes) {
  if (!mid_line()) partial_since_.reset();
  framer_.push(bytes);
}

std::optional<LineFramer::Line> Incoming::next() {
  auto line = framer_.next();
  if (line) partial_since_.reset();
  return line;
}

void Incoming::note_half_line(TimePoint now) {
  if (!mid_line()) {
    partial_since_.reset();
  } else if (!partial_since_) {
    partial_since_ = now;
  }
}

void Incoming::clear() {
  framer_.clear();
  partial_since_.reset();
}

std::optional<TimePoint> Incoming::unended_from() const {
  if (!partial_since_) return std::nullopt;
  return *partial_since_ + kPartialLineLimit;
}

bool Incoming::drop_unended(TimePoint now) {
  if (!partial_since_ || now < *unended_from() || !guarded(Guard::unended_lines)) return false;
  clear();
  return true;
}

}  // namespace axisgate::shot
