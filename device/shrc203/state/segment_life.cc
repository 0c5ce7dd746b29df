#include "device/shrc203/state/segment_life.h"

#include <array>

#include "device/core/transitions.h"

namespace axisgate::shrc203 {
std::string_view name(SegmentPhase phase) {
  static constexpr std::array<std::string_view, kSegmentPhases> kNames = {"stationary", "setting", "running",
                                                                          "refilling",  "chained", "doubtful"};
  return kNames.at(static_cast<std::size_t>(phase));
}
std::string_view name(SegmentEvent event) {
  static constexpr std::array<std::string_view, kSegmentEvents> kNames = {
      "set_asked",      "start_accepted", "start_doubted",     "refill_asked", "refill_accepted",
      "refill_doubted", "ended",          "became_stationary", "found"};
  return kNames.at(static_cast<std::size_t>(event));
}
// README.md has a drawing of this table.
std::optional<SegmentPhase> next(SegmentPhase phase, SegmentEvent event) {
  using Phase = SegmentPhase;
  using Event = SegmentEvent;
  static constexpr auto kTable = std::to_array<Transition<Phase, Event>>({
      {Phase::stationary, Event::set_asked, Phase::setting},
      {Phase::setting, Event::start_accepted, Phase::running},
      {Phase::setting, Event::start_doubted, Phase::doubtful},
      {Phase::running, Event::refill_asked, Phase::refilling},
      {Phase::running, Event::became_stationary, Phase::stationary},
      {Phase::refilling, Event::refill_accepted, Phase::chained},
      {Phase::refilling, Event::refill_doubted, Phase::doubtful},
      {Phase::chained, Event::ended, Phase::running},
      {Phase::doubtful, Event::found, Phase::stationary},
  });
  return next_in(kTable, phase, event);
}

}  // namespace axisgate::shrc203
