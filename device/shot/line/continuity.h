// Check that the controller has not restarted since its previous reply.
//
// A controller that restarts reads nothing for a while, and afterwards ?:CMD no longer reports the line before it
// (manual 40), 46) RESET:). So a line written soon after a reply needs no check. After a longer pause ?:CMD must be the
// first line, because it would report any other line sent since. Its reply also shows whether another program has
// written to the controller.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/time.h"
#include "device/shot/limits.h"

namespace axisgate::shot {

class Continuity {
 public:
  // Forgets all lines: after a connect it is unknown what the controller received before.
  void connected();
  // Called when the handshake has passed, or when other facts show that the controller has not restarted.
  void begin(TimePoint now);

  // Reports whether ?:CMD must be sent before any other line.
  bool due(TimePoint now) const { return now - alive_ > kRestartMin; }
  // Reports whether a restart is possible, so that other facts must decide.
  bool open() const { return open_; }
  // Reports whether a restart is possible only because a reply was late.
  bool only_late() const { return open_ && only_late_; }

  // Called when `line` is written. `on_the_wire` is the longest time for its bytes and those of the reply.
  void wrote(std::string_view line, Duration on_the_wire, TimePoint now);
  // Called when the newest line was answered. `taken` is false for NG; the manual does not say whether ?:CMD reports a
  // refused line.
  void answered(bool taken, TimePoint now);

  // Reports whether `line` can be the reply to ?:CMD. A restarted controller may report anything; other facts decide
  // about that case.
  bool could_be(std::string_view line) const;
  enum class Verdict { same, open, foreign };
  // Compares the reply to ?:CMD with the lines sent.
  Verdict compare(std::string_view line_before, TimePoint now);

 private:
  void doubt(bool strongly, TimePoint due, TimePoint now);

  std::vector<std::string> before_;    // lines that ?:CMD may report without a restart
  std::vector<std::string> unproven_;  // this gateway's lines that ?:CMD may report with or without a restart
  std::string newest_;
  bool answered_ = true;  // the newest line was answered
  bool refused_ = false;  // the line answered last was refused; it may have arrived as another line
  bool in_time_ = false;  // the newest line was written before any restart could have ended
  bool open_ = false;
  bool only_late_ = false;
  TimePoint due_{};                        // time by which the newest line is answered, unless the controller is slow
  std::optional<TimePoint> question_due_;  // the same for the oldest unanswered ?:CMD
  TimePoint alive_{};
};

}  // namespace axisgate::shot
