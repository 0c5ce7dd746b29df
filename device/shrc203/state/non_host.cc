#include "device/shrc203/state/non_host.h"

#include <fmt/format.h>

#include <array>

#include "device/core/transitions.h"

namespace axisgate::shrc203 {
namespace {

NonHostEvent entering(Mode mode) {
  switch (mode) {
    case Mode::host:
      return NonHostEvent::entered_host;
    case Mode::memory_switches:
      return NonHostEvent::entered_switches;
    case Mode::program:
      return NonHostEvent::entered_program;
    case Mode::program_edit:
      break;
  }
  return NonHostEvent::entered_edit;
}

}  // namespace

std::string_view name(NonHostPhase phase) {
  static constexpr std::array<std::string_view, kNonHostPhases> kNames = {"host", "leaving", "memory_switches",
                                                                          "program", "program_edit"};
  return kNames.at(static_cast<std::size_t>(phase));
}
std::string_view name(NonHostEvent event) {
  static constexpr std::array<std::string_view, kNonHostEvents> kNames = {
      "began", "entered_host", "entered_switches", "entered_program", "entered_edit", "returned"};
  return kNames.at(static_cast<std::size_t>(event));
}
// README.md has a drawing of this table. A caller's lines may enter any mode, so every mode may be entered once a visit
// has begun.
std::optional<NonHostPhase> next(NonHostPhase phase, NonHostEvent event) {
  using Phase = NonHostPhase;
  using Event = NonHostEvent;
  static constexpr auto kTable = std::to_array<Transition<Phase, Event>>({
      {Phase::host, Event::began, Phase::leaving},
      {Phase::host, Event::returned, Phase::host},
      {Phase::leaving, Event::entered_host, Phase::leaving},
      {Phase::leaving, Event::entered_switches, Phase::memory_switches},
      {Phase::leaving, Event::entered_program, Phase::program},
      {Phase::leaving, Event::entered_edit, Phase::program_edit},
      {Phase::leaving, Event::returned, Phase::host},
      {Phase::memory_switches, Event::entered_host, Phase::leaving},
      {Phase::memory_switches, Event::entered_switches, Phase::memory_switches},
      {Phase::memory_switches, Event::entered_program, Phase::program},
      {Phase::memory_switches, Event::entered_edit, Phase::program_edit},
      {Phase::memory_switches, Event::returned, Phase::host},
      {Phase::program, Event::entered_host, Phase::leaving},
      {Phase::program, Event::entered_switches, Phase::memory_switches},
      {Phase::program, Event::entered_program, Phase::program},
      {Phase::program, Event::entered_edit, Phase::program_edit},
      {Phase::program, Event::returned, Phase::host},
      {Phase::program_edit, Event::entered_host, Phase::leaving},
      {Phase::program_edit, Event::entered_switches, Phase::memory_switches},
      {Phase::program_edit, Event::entered_program, Phase::program},
      {Phase::program_edit, Event::entered_edit, Phase::program_edit},
      {Phase::program_edit, Event::returned, Phase::host},
  });
  return next_in(kTable, phase, event);
}

void NonHost::entered(Mode mode) { change(entering(mode)); }

Mode NonHost::mode() const {
  switch (phase_) {
    case NonHostPhase::memory_switches:
      return Mode::memory_switches;
    case NonHostPhase::program:
      return Mode::program;
    case NonHostPhase::program_edit:
      return Mode::program_edit;
    case NonHostPhase::host:
    case NonHostPhase::leaving:
      break;
  }
  return Mode::host;
}

Problem NonHost::problem() const {
  const bool program = phase_ == NonHostPhase::program || phase_ == NonHostPhase::program_edit;
  return {.reason = Reason::wrong_mode,
          .message = fmt::format("somebody has the controller in {} mode, where it answers nobody else",
                                 program ? "program" : "memory switch edit"),
          .hint = "try again when it is back in HOST"};
}

void NonHost::change(NonHostEvent event) {
  const auto to = next(phase_, event);
  if (!to) return violations_.illegal("non_host", name(phase_), name(event));
  phase_ = *to;
}

}  // namespace axisgate::shrc203
