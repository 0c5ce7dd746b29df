// Whether the controller that answers now has been running ever since it answered before.
//
// A restart takes a while in which nothing is read, and afterwards ?:CMD no longer reports the line before it (manual
// 40), 46) RESET:). So when a line is written soon after an answer, nothing can have happened in between. After a
// longer pause ?:CMD must be the first line, because ?:CMD would report any other line from then on. The same answer
// shows whether somebody else has written to the controller.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/time.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

class Continuity {
 public:
  // After a connect nothing is known of what the controller took before.
  void connected();
  // The handshake has passed, or other facts show that it is still the same.
  void begin(TimePoint now);

  // Whether ?:CMD is to be asked before anything else is.
  bool due(TimePoint now) const { return now - alive_ > kRestartMin; }
  // Nothing shows whether the controller has restarted: other facts must.
  bool open() const { return open_; }
  // ... but the only sign of a restart is that an answer came late.
  bool only_late() const { return open_ && only_late_; }

  // Its bytes and those of the answer take `on_the_wire` at most.
  void wrote(std::string_view line, Duration on_the_wire, TimePoint now);
  // The newest line was answered. `taken`: not by NG; whether ?:CMD reports a refused line is an open question.
  void answered(bool taken, TimePoint now);

  // Whether this can be what ?:CMD reports. After a restart it may report anything; that too is left to other facts.
  bool could_be(std::string_view line) const;
  enum class Verdict { same, open, foreign };
  // What ?:CMD was answered.
  Verdict compare(std::string_view line_before, TimePoint now);

 private:
  void doubt(bool strongly, TimePoint due, TimePoint now);

  std::vector<std::string> before_;    // what ?:CMD may tell when there was no restart
  std::vector<std::string> unproven_;  // what it may tell just as well after a restart, and is ours all the same
  std::string newest_;
  bool answered_ = true;  // the newest line was
  bool refused_ = false;  // the line answered last was, and may have come in as another
  bool in_time_ = false;  // the newest line was written before any restart could have ended
  bool open_ = false;
  bool only_late_ = false;
  TimePoint due_{};                        // the newest line's answer, unless the controller is slow
  std::optional<TimePoint> question_due_;  // that of the oldest ?:CMD without an answer
  TimePoint alive_{};
};

}  // namespace axisgate::shrc203
