// The abort of a mill: from the request until it has reached the mill, whether a job is sent or none.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "device/core/line_machine.h"
#include "device/core/time.h"
#include "device/core/violations.h"
#include "device/jobs/send_settings.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// README.md has the table of what leads from one to another.
enum class AbortPhase {
  none,    // no abort was requested, or the mill has it
  waits,   // for the line
  leaves,  // this host
  travels  // to the mill: a converter may still hold it; last: kAbortPhases
};
inline constexpr std::size_t kAbortPhases = static_cast<std::size_t>(AbortPhase::travels) + 1;

enum class AbortEvent {
  postponed,  // the line is closed
  written,    // to the line
  left,       // this host
  arrived,    // at the mill, at the latest
  line_lost   // last: kAbortEvents
};
inline constexpr std::size_t kAbortEvents = static_cast<std::size_t>(AbortEvent::line_lost) + 1;

std::string_view name(AbortPhase phase);  // "none", as in README.md
std::string_view name(AbortEvent event);

// Returns the phase after the event; nullopt if the table has none.
std::optional<AbortPhase> next(AbortPhase phase, AbortEvent event);

// Not thread safe. `now` never goes back.
class Abort {
 public:
  // The referenced objects must outlive this one.
  Abort(const Profile& profile, const jobs::SendSettings& settings, FlowLink& line, Violations& violations)
      : profile_(profile), settings_(settings), line_(line), violations_(violations) {}

  // Writes the abort to the line, which is open. `rests`: the spindle may be stationary when it reaches the mill.
  void write(bool rests, TimePoint now);
  // Keeps the abort until the line is back and write() is called.
  void postpone() { change(AbortEvent::postponed); }
  // Keeps an abort that may not have reached the mill.
  void line_lost(TimePoint now);
  // Follows an abort out of the host. Ignores flow control that forbids it for longer than kHeldBeforeIgnored.
  void advance(TimePoint now);

  AbortPhase phase() const { return phase_; }
  // Reports whether it is to be sent, or has not left this host.
  bool waits() const { return phase_ == AbortPhase::waits || phase_ == AbortPhase::leaves; }

  static constexpr Duration kHeldBeforeIgnored = std::chrono::milliseconds(200);
  // Longest time between two calls of advance() while it leaves the host.
  static constexpr Duration kLook = std::chrono::milliseconds(5);

 private:
  void change(AbortEvent event);
  void note_arrival(TimePoint now);

  const Profile& profile_;
  const jobs::SendSettings& settings_;
  FlowLink& line_;
  Violations& violations_;
  AbortPhase phase_ = AbortPhase::none;
  TimePoint written_{};  // when it leaves
  TimePoint arrives_{};  // at the latest, when it travels
};

}  // namespace axisgate::rml1
