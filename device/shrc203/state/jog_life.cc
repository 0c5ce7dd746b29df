#include "device/shrc203/state/jog_life.h"

#include <array>

#include "device/core/transitions.h"

namespace axisgate::shrc203 {
std::string_view name(JogPhase phase) {
  static constexpr std::array<std::string_view, kJogPhases> kNames = {"preparing", "running", "changing_speed",
                                                                      "ending", "stopping"};
  return kNames.at(static_cast<std::size_t>(phase));
}
std::string_view name(JogEvent event) {
  static constexpr std::array<std::string_view, kJogEvents> kNames = {"begun",    "speed_asked", "speed_answered",
                                                                      "must_end", "stop_asked",  "stop_answered"};
  return kNames.at(static_cast<std::size_t>(event));
}
// README.md has a drawing of this table.
std::optional<JogPhase> next(JogPhase phase, JogEvent event) {
  using Phase = JogPhase;
  using Event = JogEvent;
  static constexpr auto kTable = std::to_array<Transition<Phase, Event>>({
      {Phase::preparing, Event::begun, Phase::running},
      {Phase::preparing, Event::must_end, Phase::ending},
      {Phase::running, Event::speed_asked, Phase::changing_speed},
      {Phase::running, Event::must_end, Phase::ending},
      {Phase::changing_speed, Event::speed_answered, Phase::running},
      {Phase::changing_speed, Event::must_end, Phase::ending},
      {Phase::ending, Event::begun, Phase::ending},
      {Phase::ending, Event::speed_answered, Phase::ending},
      {Phase::ending, Event::must_end, Phase::ending},
      {Phase::ending, Event::stop_asked, Phase::stopping},
      {Phase::stopping, Event::begun, Phase::stopping},
      {Phase::stopping, Event::speed_answered, Phase::stopping},
      {Phase::stopping, Event::must_end, Phase::stopping},
      {Phase::stopping, Event::stop_answered, Phase::ending},
  });
  return next_in(kTable, phase, event);
}

}  // namespace axisgate::shrc203
