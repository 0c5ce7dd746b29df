// Lines received from the controller, and the state of an incomplete one.
#pragma once

#include <optional>
#include <string_view>

#include "device/core/line_framer.h"
#include "device/core/time.h"

namespace axisgate::shot {

// Shown in place of an incomplete line that was discarded.
inline constexpr std::string_view kUnended = "(a line that did not end)";

class Incoming {
 public:
  void push(std::string_view bytes);
  std::optional<LineFramer::Line> next();
  // Call after the last next(): notes when an incomplete line was first seen.
  void note_half_line(TimePoint now);
  void clear();

  bool mid_line() const { return framer_.mid_line(); }
  // Time from which an incomplete line counts as one that never ends; nullopt if no line is incomplete.
  std::optional<TimePoint> unended_from() const;
  // Discards an incomplete line that did not end in time. Returns false if there is none.
  bool drop_unended(TimePoint now);

 private:
  LineFramer framer_;
  std::optional<TimePoint> partial_since_;  // time at which the present incomplete line was noticed
};

}  // namespace axisgate::shot
