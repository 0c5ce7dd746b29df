#include "device/rml1/sending/abort.h"

#include <array>

#include "device/core/transitions.h"
#include "device/jobs/guard.h"
#include "device/rml1/sending/commands.h"
#include "device/rml1/sending/delivery.h"

namespace axisgate::rml1 {
namespace {

constexpr std::array<std::string_view, kAbortPhases> kAbortPhaseNames = {"none", "waits", "leaves", "travels"};
constexpr std::array<std::string_view, kAbortEvents> kAbortEventNames = {"postponed", "written", "left", "arrived",
                                                                         "line_lost"};

}  // namespace

std::string_view name(AbortPhase phase) { return kAbortPhaseNames.at(static_cast<std::size_t>(phase)); }
std::string_view name(AbortEvent event) { return kAbortEventNames.at(static_cast<std::size_t>(event)); }

std::optional<AbortPhase> next(AbortPhase phase, AbortEvent event) {
  using enum AbortPhase;
  using Change = Transition<AbortPhase, AbortEvent>;
  static constexpr std::array kTable = {
      Change{none, AbortEvent::postponed, waits},   Change{none, AbortEvent::written, leaves},
      Change{none, AbortEvent::line_lost, none},    Change{waits, AbortEvent::postponed, waits},
      Change{waits, AbortEvent::written, leaves},   Change{waits, AbortEvent::line_lost, waits},
      Change{leaves, AbortEvent::written, leaves},  Change{leaves, AbortEvent::left, travels},
      Change{leaves, AbortEvent::line_lost, waits}, Change{travels, AbortEvent::written, leaves},
      Change{travels, AbortEvent::arrived, none},   Change{travels, AbortEvent::line_lost, waits},
  };
  return next_in(kTable, phase, event);
}

void Abort::change(AbortEvent event) {
  if (const auto to = next(phase_, event)) {
    phase_ = *to;
  } else {
    violations_.illegal("abort", name(phase_), name(event));
  }
}

void Abort::write(bool rests, TimePoint now) {
  line_.write(abort_commands(profile_, rests));
  change(AbortEvent::written);
  written_ = now;
}

void Abort::line_lost(TimePoint now) {
  note_arrival(now);
  change(AbortEvent::line_lost);
}

void Abort::note_arrival(TimePoint now) {
  if (phase_ == AbortPhase::travels && arrives_ <= now) change(AbortEvent::arrived);
}

void Abort::advance(TimePoint now) {
  note_arrival(now);
  if (phase_ != AbortPhase::leaves) return;
  if (line_.unsent() == 0) {
    line_.ignore_flow_control(false);
    change(AbortEvent::left);
    left_ = now;
    arrives_ = now + transmit_time(settings_.converter, settings_.baud);
    return;
  }
  // The host cannot see an XOFF; it sees only that bytes do not leave.
  if (guarded(jobs::MillGuard::abort_is_not_held) && now - written_ >= kHeldBeforeIgnored)
    line_.ignore_flow_control(true);
}

}  // namespace axisgate::rml1
