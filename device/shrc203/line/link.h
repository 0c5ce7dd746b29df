// The state of the link to the controller: one enum, changed in one place by the table of README.md.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

enum class LinkPhase {
  closed,              // the port is shut; it is opened again after the backoff
  reopening,           // shut, and opened at once: a stop waits
  babbling,            // shut after a flood of bytes; it is opened again after the backoff
  identifying,         // open; the first barrier asks who is there
  listening,           // the same after a flood
  handshaking,         // the controller has said who it is; nothing but the handshake's questions is sent
  handshake_doubtful,  // a barrier within the handshake
  up,                  // the handshake has passed
  doubtful,            // a barrier: nothing but a stop is sent
  restart_suspected,   // nothing but a stop and what shows whether the controller has restarted is sent
  restart_doubtful,    // a barrier meanwhile
};
inline constexpr std::size_t kLinkPhases = 11;

enum class LinkEvent {
  port_opened,
  lost,            // the port was shut, by either side
  flooded,         // shut, since the device sends without end
  stop_waits,      // a stop came while the port was shut
  identified,      // the first barrier has passed
  answer_doubted,  // a barrier has begun
  barrier_passed,  // any later one
  handshake_passed,
  restart_suspected,
  same_controller,  // the suspected restart was none
};
inline constexpr std::size_t kLinkEvents = 10;

std::string_view name(LinkPhase phase);  // "closed", as in README.md
std::string_view name(LinkEvent event);

// The phase after the event; nothing where the table has none.
std::optional<LinkPhase> next(LinkPhase phase, LinkEvent event);

// What callers are shown of a phase.
LinkState shown(LinkPhase phase);

class Link {
 public:
  LinkPhase phase() const { return phase_; }
  // False for an event that the phase does not permit: the phase stays.
  [[nodiscard]] bool happened(LinkEvent event);

  bool port_open() const { return phase_ >= LinkPhase::identifying; }
  // Reports whether the first barrier is in progress.
  bool identifying() const { return phase_ == LinkPhase::identifying || phase_ == LinkPhase::listening; }
  // Whether the handshake has passed since the port was opened.
  bool trusted() const { return phase_ >= LinkPhase::up; }
  bool restart_suspected() const { return phase_ >= LinkPhase::restart_suspected; }

 private:
  LinkPhase phase_ = LinkPhase::closed;
};

}  // namespace axisgate::shrc203
