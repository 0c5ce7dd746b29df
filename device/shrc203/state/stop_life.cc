#include "device/shrc203/state/stop_life.h"

#include <array>

#include "device/core/transitions.h"

namespace axisgate::shrc203 {
std::string_view name(StopPhase phase) {
  static constexpr std::array<std::string_view, kStopPhases> kNames = {"writing", "slowing", "slowing_again", "ended"};
  return kNames.at(static_cast<std::size_t>(phase));
}
std::string_view name(StopEvent event) {
  static constexpr std::array<std::string_view, kStopEvents> kNames = {"answered", "refused", "ran_on", "finished"};
  return kNames.at(static_cast<std::size_t>(event));
}
// As README.md draws it.
std::optional<StopPhase> next(StopPhase phase, StopEvent event) {
  using Phase = StopPhase;
  using Event = StopEvent;
  static constexpr auto kTable = std::to_array<Transition<Phase, Event>>({
      {Phase::writing, Event::answered, Phase::slowing},
      {Phase::writing, Event::refused, Phase::ended},
      {Phase::slowing, Event::ran_on, Phase::slowing_again},
      {Phase::slowing, Event::finished, Phase::ended},
      {Phase::slowing_again, Event::finished, Phase::ended},
  });
  return next_in(kTable, phase, event);
}

}  // namespace axisgate::shrc203
