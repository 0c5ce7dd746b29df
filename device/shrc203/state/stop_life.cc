#include "device/shrc203/state/stop_life.h"

#include <array>

#include "device/core/transitions.h"

namespace axisgate::shrc203 {

std::string_view name(StopEvent event) {
  static constexpr std::array<std::string_view, kStopEvents> kNames = {"wrote", "seen_stationary",
                                                                       "returned_stationary", "widened", "abandoned"};
  return kNames.at(static_cast<std::size_t>(event));
}

// README.md has a drawing of this table.
std::optional<StopState> next(StopState state, StopEvent event) {
  using State = StopState;
  using Event = StopEvent;
  static constexpr auto kTable = std::to_array<Transition<State, Event>>({
      {State::asked, Event::wrote, State::written},
      {State::asked, Event::returned_stationary, State::confirmed},
      {State::asked, Event::widened, State::replaced},
      {State::asked, Event::abandoned, State::withdrawn},
      {State::written, Event::wrote, State::written},
      {State::written, Event::seen_stationary, State::confirmed},
      {State::written, Event::widened, State::replaced},
      {State::written, Event::abandoned, State::withdrawn},
  });
  return next_in(kTable, state, event);
}

}  // namespace axisgate::shrc203
