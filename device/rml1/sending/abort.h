// The abort of a mill, from its request until it has reached the mill, with or without a running job.
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

// Phases of an abort. README.md has the table of phases and events.
enum class AbortPhase {
  none,    // no abort was requested, or the mill has received it
  waits,   // the line is closed, and the abort is sent when the line is open again
  leaves,  // bytes of the abort are still in this host
  travels  // a converter may still contain the abort; must be the last value: kAbortPhases
};
inline constexpr std::size_t kAbortPhases = static_cast<std::size_t>(AbortPhase::travels) + 1;

enum class AbortEvent {
  postponed,  // the abort must wait until the line is open
  written,    // the abort was written to the line
  left,       // all bytes of the abort have left this host
  arrived,    // the abort has had enough time to pass a converter
  line_lost   // must be the last value: kAbortEvents
};
inline constexpr std::size_t kAbortEvents = static_cast<std::size_t>(AbortEvent::line_lost) + 1;

std::string_view name(AbortPhase phase);  // "none", as in README.md
std::string_view name(AbortEvent event);

// Returns the phase after the event; nullopt if the table does not allow the event.
std::optional<AbortPhase> next(AbortPhase phase, AbortEvent event);

// An Abort writes the abort of one mill and follows it until it has arrived. Not thread safe. `now` must never
// decrease.
class Abort {
 public:
  // The referenced objects must outlive this one.
  Abort(const Profile& profile, const jobs::SendSettings& settings, FlowLink& line, Violations& violations)
      : profile_(profile), settings_(settings), line_(line), violations_(violations) {}

  // Writes the abort to the line, which must be open. `rests`: true if the spindle may be stationary when the abort
  // reaches the mill.
  void write(bool rests, TimePoint now);
  // Notes that an abort must be written, by a later call of write(), when the line is open again.
  void postpone() { change(AbortEvent::postponed); }
  // Notes that the line was lost. An abort that may not have reached the mill must then be written again.
  void line_lost(TimePoint now);
  // Updates the phase. Ignores flow control if bytes of the abort are still in the host after kHeldBeforeIgnored.
  void advance(TimePoint now);

  AbortPhase phase() const { return phase_; }
  // Reports whether the abort waits for the line, or has not left this host completely.
  bool waits() const { return phase_ == AbortPhase::waits || phase_ == AbortPhase::leaves; }
  // Returns when the last byte of the latest abort had left this host, and until when a converter may have contained
  // it; the beginning of time if none has left.
  TimePoint left_at() const { return left_; }
  TimePoint arrived_by() const { return arrives_; }

  static constexpr Duration kHeldBeforeIgnored = std::chrono::milliseconds(200);
  // Longest time between two calls of advance() in phase `leaves`.
  static constexpr Duration kLook = std::chrono::milliseconds(5);

 private:
  void change(AbortEvent event);
  void note_arrival(TimePoint now);

  const Profile& profile_;
  const jobs::SendSettings& settings_;
  FlowLink& line_;
  Violations& violations_;
  AbortPhase phase_ = AbortPhase::none;
  TimePoint written_{};                   // time of write(), for phase `leaves`
  TimePoint left_ = TimePoint::min();     // time of the change to phase `travels`
  TimePoint arrives_ = TimePoint::min();  // latest time of arrival at the mill, set with left_
};

}  // namespace axisgate::rml1
