#include "device/shrc203/state/motion_life.h"

#include <array>
#include <utility>

#include "device/core/transitions.h"

namespace axisgate::shrc203 {
namespace {

// Other combinations change nothing.
constexpr auto kInterrupted = std::to_array<Transition<Interruption, InterruptionEvent>>({
    {Interruption::none, InterruptionEvent::stop_asked, Interruption::stop},
    {Interruption::none, InterruptionEvent::line_lost, Interruption::line_lost},
    {Interruption::stop, InterruptionEvent::line_lost, Interruption::stop_and_line_lost},
    {Interruption::line_lost, InterruptionEvent::stop_asked, Interruption::stop_and_line_lost},
});

constexpr std::array<std::string_view, kInterruptions> kInterruptionNames = {"none", "stop", "line_lost",
                                                                             "stop_and_line_lost"};
constexpr std::array<std::string_view, kInterruptionEvents> kInterruptionEventNames = {"stop_asked", "line_lost"};

}  // namespace

std::string_view name(MotionPhase phase) {
  static constexpr std::array<std::string_view, kMotionPhases> kNames = {"queued",  "preparing", "resting", "setting",
                                                                         "running", "restoring", "ended"};
  return kNames.at(static_cast<std::size_t>(phase));
}
std::string_view name(MotionEvent event) {
  static constexpr std::array<std::string_view, kMotionEvents> kNames = {
      "entered", "written", "started", "finished", "finished_to_restore", "left"};
  return kNames.at(static_cast<std::size_t>(event));
}
std::string_view name(Interruption interruption) {
  return kInterruptionNames.at(static_cast<std::size_t>(interruption));
}
std::string_view name(InterruptionEvent event) { return kInterruptionEventNames.at(static_cast<std::size_t>(event)); }

// README.md has a drawing of this table.
std::optional<MotionPhase> next(MotionPhase phase, MotionEvent event) {
  using Phase = MotionPhase;
  using Event = MotionEvent;
  static constexpr auto kTable = std::to_array<Transition<Phase, Event>>({
      {Phase::queued, Event::entered, Phase::preparing},
      {Phase::queued, Event::finished, Phase::ended},
      {Phase::preparing, Event::written, Phase::setting},
      {Phase::preparing, Event::started, Phase::resting},
      {Phase::preparing, Event::finished, Phase::ended},
      {Phase::preparing, Event::finished_to_restore, Phase::restoring},
      {Phase::resting, Event::written, Phase::running},
      {Phase::resting, Event::finished, Phase::ended},
      {Phase::resting, Event::finished_to_restore, Phase::restoring},
      {Phase::setting, Event::written, Phase::setting},
      {Phase::setting, Event::started, Phase::running},
      {Phase::setting, Event::finished, Phase::ended},
      {Phase::setting, Event::finished_to_restore, Phase::restoring},
      {Phase::running, Event::written, Phase::running},
      {Phase::running, Event::finished, Phase::ended},
      {Phase::running, Event::finished_to_restore, Phase::restoring},
      {Phase::restoring, Event::left, Phase::ended},
  });
  return next_in(kTable, phase, event);
}
Interruption next(Interruption interruption, InterruptionEvent event) {
  return next_in(kInterrupted, interruption, event).value_or(interruption);
}

bool MotionLife::unstarted() const {
  return phase_ == MotionPhase::queued || phase_ == MotionPhase::preparing || phase_ == MotionPhase::setting;
}

bool MotionLife::stop_asked() const {
  return interruption_ == Interruption::stop || interruption_ == Interruption::stop_and_line_lost;
}

bool MotionLife::line_lost() const {
  return interruption_ == Interruption::line_lost || interruption_ == Interruption::stop_and_line_lost;
}

stage::MotionState MotionLife::shown() const {
  if (unstarted()) return stage::MotionState::queued;
  return stop_asked() ? stage::MotionState::stopping : stage::MotionState::running;
}

bool MotionLife::happened(MotionEvent event) {
  const auto to = next(phase_, event);
  if (to) phase_ = *to;
  return to.has_value();
}

void MotionLife::stop(std::string who) {
  interruption_ = next(interruption_, InterruptionEvent::stop_asked);
  stopped_by_ = std::move(who);
}

void MotionLife::lose_line(std::string why) {
  interruption_ = next(interruption_, InterruptionEvent::line_lost);
  line_problem_ = std::move(why);
}

}  // namespace axisgate::shrc203
