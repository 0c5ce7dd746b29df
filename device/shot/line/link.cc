#include "device/shot/line/link.h"

#include "device/core/transitions.h"

namespace axisgate::shot {
namespace {

// README.md has a drawing of this table.
constexpr auto kTransitions = std::to_array<Transition<LinkPhase, LinkEvent>>({
    {LinkPhase::closed, LinkEvent::port_opened, LinkPhase::identifying},
    {LinkPhase::closed, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::closed, LinkEvent::stop_waits, LinkPhase::reopening},
    {LinkPhase::reopening, LinkEvent::port_opened, LinkPhase::identifying},
    {LinkPhase::reopening, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::babbling, LinkEvent::port_opened, LinkPhase::listening},
    {LinkPhase::babbling, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::babbling, LinkEvent::stop_waits, LinkPhase::reopening},
    {LinkPhase::identifying, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::identifying, LinkEvent::flooded, LinkPhase::babbling},
    {LinkPhase::identifying, LinkEvent::identified, LinkPhase::handshaking},
    {LinkPhase::listening, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::listening, LinkEvent::flooded, LinkPhase::babbling},
    {LinkPhase::listening, LinkEvent::identified, LinkPhase::handshaking},
    {LinkPhase::handshaking, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::handshaking, LinkEvent::flooded, LinkPhase::babbling},
    {LinkPhase::handshaking, LinkEvent::answer_doubted, LinkPhase::handshake_doubtful},
    {LinkPhase::handshaking, LinkEvent::handshake_passed, LinkPhase::up},
    {LinkPhase::handshake_doubtful, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::handshake_doubtful, LinkEvent::flooded, LinkPhase::babbling},
    {LinkPhase::handshake_doubtful, LinkEvent::barrier_passed, LinkPhase::handshaking},
    {LinkPhase::handshake_doubtful, LinkEvent::handshake_passed, LinkPhase::doubtful},
    {LinkPhase::up, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::up, LinkEvent::flooded, LinkPhase::babbling},
    {LinkPhase::up, LinkEvent::answer_doubted, LinkPhase::doubtful},
    {LinkPhase::up, LinkEvent::restart_suspected, LinkPhase::restart_suspected},
    {LinkPhase::doubtful, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::doubtful, LinkEvent::flooded, LinkPhase::babbling},
    {LinkPhase::doubtful, LinkEvent::barrier_passed, LinkPhase::up},
    {LinkPhase::doubtful, LinkEvent::restart_suspected, LinkPhase::restart_doubtful},
    {LinkPhase::restart_suspected, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::restart_suspected, LinkEvent::flooded, LinkPhase::babbling},
    {LinkPhase::restart_suspected, LinkEvent::answer_doubted, LinkPhase::restart_doubtful},
    {LinkPhase::restart_suspected, LinkEvent::same_controller, LinkPhase::up},
    {LinkPhase::restart_doubtful, LinkEvent::lost, LinkPhase::closed},
    {LinkPhase::restart_doubtful, LinkEvent::flooded, LinkPhase::babbling},
    {LinkPhase::restart_doubtful, LinkEvent::barrier_passed, LinkPhase::restart_suspected},
    {LinkPhase::restart_doubtful, LinkEvent::same_controller, LinkPhase::doubtful},
});

constexpr std::array<std::string_view, kLinkPhases> kPhaseNames = {
    "closed", "reopening", "babbling",          "identifying",     "listening", "handshaking", "handshake_doubtful",
    "up",     "doubtful",  "restart_suspected", "restart_doubtful"};
constexpr std::array<std::string_view, kLinkEvents> kEventNames = {
    "port_opened",    "lost",           "flooded",          "stop_waits",        "identified",
    "answer_doubted", "barrier_passed", "handshake_passed", "restart_suspected", "same_controller"};

}  // namespace

std::string_view name(LinkPhase phase) { return kPhaseNames.at(static_cast<std::size_t>(phase)); }
std::string_view name(LinkEvent event) { return kEventNames.at(static_cast<std::size_t>(event)); }

std::optional<LinkPhase> next(LinkPhase phase, LinkEvent event) { return next_in(kTransitions, phase, event); }

LinkState shown(LinkPhase phase) {
  switch (phase) {
    case LinkPhase::closed:
    case LinkPhase::reopening:
      return LinkState::down;
    case LinkPhase::babbling:
    case LinkPhase::listening:
      return LinkState::babbling;
    case LinkPhase::identifying:
    case LinkPhase::handshaking:
    case LinkPhase::handshake_doubtful:
      return LinkState::connecting;
    case LinkPhase::up:
      return LinkState::up;
    case LinkPhase::doubtful:
    case LinkPhase::restart_suspected:
    case LinkPhase::restart_doubtful:
      break;
  }
  return LinkState::doubtful;
}

bool Link::happened(LinkEvent event) {
  const auto to = next(phase_, event);
  if (to) phase_ = *to;
  return to.has_value();
}

}  // namespace axisgate::shot
