// The life of a jog, from its asking to its stop: one enum, changed in one place by the table of README.md. What the
// motion of it has come to otherwise stands in motion_life.h.
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
  preparing,       // its G: has not gone out
  running,         // its G: may have gone out
  changing_speed,  // and a JD: is on its way
  ending,          // it must end, and no stop is on its way
  stopping,        // a stop is on its way
};
inline constexpr std::size_t kJogPhases = 5;

enum class JogEvent {
  begun,           // its G: goes out
  speed_asked,     // a JD: goes out
  speed_answered,  // or will not be
  must_end,        // its caller wants it, or the gateway
  stop_asked,
  stop_answered,  // the jog may run on all the same
};
inline constexpr std::size_t kJogEvents = 6;

std::string_view name(JogPhase phase);  // "preparing", as in README.md
std::string_view name(JogEvent event);
// The phase after the event; nothing where the table has none.
std::optional<JogPhase> next(JogPhase phase, JogEvent event);

// What a jog needs beside its motion.
struct Jog {
  explicit Jog(Executor& executor) : changed(executor) {}

  bool must_end() const { return phase >= JogPhase::ending; }

  JogPhase phase = JogPhase::preparing;  // changed by Motions::change() alone
  Signal changed;                        // a renewal, a new speed, its start, its end
  TimePoint renewed{};
  TimePoint begun{};                    // when its G: may have been written; of one that is preparing nothing
  std::uint64_t epoch = 0;              // of the device, when the jog was requested
  std::map<int, int> directions;        // by axis
  std::map<int, std::int64_t> speeds;   // requested, by axis; in pulses/s
  std::map<int, std::int64_t> sent;     // the last that JD: was accepted with
  std::map<int, std::int64_t> fastest;  // that the axis may run at by now
  std::optional<Problem> why;           // it must end; nothing: its caller wants it
};

}  // namespace axisgate::shrc203
