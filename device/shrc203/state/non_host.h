// Whether somebody's transaction has led the controller out of HOST (manual 102) to 126)): one enum, changed in one
// place by the table of README.md. Nobody else is answered meanwhile.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "device/core/problem.h"
#include "device/core/violations.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {

enum class NonHostPhase {
  host,             // nobody has
  leaving,          // a transaction is about to, or is about to come back
  memory_switches,  // MS:ON
  program,          // P:R
  program_edit,     // P:ON
};
inline constexpr std::size_t kNonHostPhases = 5;

enum class NonHostEvent {
  began,         // the first line that leads out is about to go out
  entered_host,  // a line was accepted that leads to HOST, or may have been; likewise
  entered_switches,
  entered_program,
  entered_edit,
  returned,  // ?:MODE has reported HOST
};
inline constexpr std::size_t kNonHostEvents = 6;

std::string_view name(NonHostPhase phase);  // "host", as in README.md
std::string_view name(NonHostEvent event);
// The phase after the event; nothing where the table has none.
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
  // No Q: is answered there, and nothing moves (manual 111), 117)).
  bool edits() const { return in_switches() || phase_ == NonHostPhase::program_edit; }
  Mode mode() const;

  // Why nobody else is answered: wrong_mode.
  Problem problem() const;

 private:
  void change(NonHostEvent event);

  Violations& violations_;
  NonHostPhase phase_ = NonHostPhase::host;
};

}  // namespace axisgate::shrc203
