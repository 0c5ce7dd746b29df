// State machine of a visit to a non-host mode by a transaction (manual 102) to 126)): one enum, changed in one place by
// the table of README.md. Other callers get no replies during a visit.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "device/core/problem.h"
#include "device/core/violations.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {

enum class NonHostPhase {
  host,             // no transaction has left HOST
  leaving,          // a transaction is about to leave HOST, or to return
  memory_switches,  // MS:ON
  program,          // P:R
  program_edit,     // P:ON
};
inline constexpr std::size_t kNonHostPhases = 5;

enum class NonHostEvent {
  began,         // the first line that leaves HOST is about to be sent
  entered_host,  // a line that leads to HOST was accepted, or may have been; likewise for the others
  entered_switches,
  entered_program,
  entered_edit,
  returned,  // ?:MODE has reported HOST
};
inline constexpr std::size_t kNonHostEvents = 6;

std::string_view name(NonHostPhase phase);  // "host", as in README.md
std::string_view name(NonHostEvent event);
// Returns the phase after the event; nullopt if the table has no such transition.
std::optional<NonHostPhase> next(NonHostPhase phase, NonHostEvent event);

class NonHost {
 public:
  explicit NonHost(Violations& violations) : violations_(violations) {}

  void began() { change(NonHostEvent::began); }
  void entered(Mode mode);
  void returned() { change(NonHostEvent::returned); }

  NonHostPhase phase() const { return phase_; }
  bool away() const { return phase_ != NonHostPhase::host; }
  bool in_program() const { return phase_ == NonHostPhase::program; }
  bool in_switches() const { return phase_ == NonHostPhase::memory_switches; }
  // Reports whether the mode is an edit mode, in which Q: is not answered and nothing moves (manual 111), 117)).
  bool edits() const { return in_switches() || phase_ == NonHostPhase::program_edit; }
  Mode mode() const;

  // Returns the problem for other callers: wrong_mode.
  Problem problem() const;

 private:
  void change(NonHostEvent event);

  Violations& violations_;
  NonHostPhase phase_ = NonHostPhase::host;
};

}  // namespace axisgate::shrc203
