// State machine of a jog, from its request to its stop: one enum, changed in one place by the table of README.md. The
// state of its motion is in motion_life.h.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string_view>

#include "device/core/problem.h"
#include "device/core/task.h"
#include "device/core/time.h"

namespace axisgate::shrc203 {

enum class JogPhase {
  preparing,       // its G: has not been sent
  running,         // its G: may have been sent
  changing_speed,  // running, and a JD: is in flight
  ending,          // must end; no stop is in flight
  stopping,        // must end; a stop is in flight
};
inline constexpr std::size_t kJogPhases = 5;

enum class JogEvent {
  begun,           // its G: is about to be sent
  speed_asked,     // a JD: is about to be sent
  speed_answered,  // the JD: was answered, or will not be
  must_end,        // its caller or the gateway ends it
  stop_asked,
  stop_answered,  // the jog may still run
};
inline constexpr std::size_t kJogEvents = 6;

std::string_view name(JogPhase phase);  // "preparing", as in README.md
std::string_view name(JogEvent event);
// Returns the phase after the event; nullopt if the table has no such transition.
std::optional<JogPhase> next(JogPhase phase, JogEvent event);

// A Jog is the state of a jog in addition to its motion's.
struct Jog {
  explicit Jog(Executor& executor) : changed(executor) {}

  bool must_end() const { return phase >= JogPhase::ending; }

  JogPhase phase = JogPhase::preparing;  // changed by Motions::jog_changed() only
  Signal changed;                        // notified by a renewal, a new speed, the start and the end
  TimePoint renewed{};
  TimePoint begun{};                    // time at which its G: may have been written; zero while preparing
  std::uint64_t epoch = 0;              // device epoch of the request
  std::map<int, int> directions;        // 1 or -1, by axis
  std::map<int, std::int64_t> speeds;   // pulses/s, requested, by axis
  std::map<int, std::int64_t> sent;     // pulses/s, from the last accepted JD:, by axis
  std::map<int, std::int64_t> fastest;  // pulses/s, highest speed that the axis may have now
  std::optional<Problem> why;           // reason why the jog must end; nullopt if its caller ends it
};

}  // namespace axisgate::shrc203
