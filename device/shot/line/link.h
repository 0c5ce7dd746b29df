// Link state machine: one enum, changed in one place by the table of README.md.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "device/shot/stage.h"

namespace axisgate::shot {

enum class LinkPhase {
  closed,              // the port is closed; it is opened again after the backoff
  reopening,           // closed, and being opened at once because a stop waits
  babbling,            // closed after a flood of bytes; it is opened again after the backoff
  identifying,         // open; the first barrier asks for the identity
  listening,           // like identifying, but after a flood
  handshaking,         // identified; only the handshake's questions are sent
  handshake_doubtful,  // a barrier within the handshake
  up,                  // the handshake has passed
  doubtful,            // a barrier is in progress: only stops are sent
  restart_suspected,   // only stops and the questions about a restart are sent
  restart_doubtful,    // a barrier while a restart is suspected
};
inline constexpr std::size_t kLinkPhases = 11;

enum class LinkEvent {
  port_opened,
  lost,            // the port was closed, by either side
  flooded,         // the port was closed because the device sends without end
  stop_waits,      // a stop was requested while the port was closed
  identified,      // the first barrier has passed
  answer_doubted,  // a barrier has begun
  barrier_passed,  // a later barrier has passed
  handshake_passed,
  restart_suspected,
  same_controller,  // the suspected restart did not happen
};
inline constexpr std::size_t kLinkEvents = 10;

std::string_view name(LinkPhase phase);  // "closed", as in README.md
std::string_view name(LinkEvent event);

// Returns the phase after the event; nullopt if the table has no such transition.
std::optional<LinkPhase> next(LinkPhase phase, LinkEvent event);

// Returns the link state that callers see for a phase.
LinkState shown(LinkPhase phase);

class Link {
 public:
  LinkPhase phase() const { return phase_; }
  // Changes the phase. Returns false, without a change, if the phase does not permit the event.
  [[nodiscard]] bool happened(LinkEvent event);

  bool port_open() const { return phase_ >= LinkPhase::identifying; }
  // Reports whether the first barrier is in progress.
  bool identifying() const { return phase_ == LinkPhase::identifying || phase_ == LinkPhase::listening; }
  // Reports whether the handshake has passed since the port was opened.
  bool trusted() const { return phase_ >= LinkPhase::up; }
  bool restart_suspected() const { return phase_ >= LinkPhase::restart_suspected; }

 private:
  LinkPhase phase_ = LinkPhase::closed;
};

}  // namespace axisgate::shot
