// A stop, from the request until the axes were seen to obey it; and the latch that an emergency stop sets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/time.h"
#include "device/stage/axes.h"

namespace axisgate::stage {

using StopId = std::uint64_t;  // 0 is none; ascends for each device

enum class StopKind { stop, emergency };  // manual 65) L:, 66) L:E

enum class StopState {
  asked,      // not written yet: the line is closed, or the controller takes no stop in its mode
  written,    // at least once; repeated until the axes were seen stationary
  confirmed,  // the axes were seen stationary, and their prebuffers empty, after it was written
  replaced,   // by a wider stop, which answers its callers
  withdrawn,  // by an administrator, since its controller will not come back
};
inline constexpr std::size_t kStopStates = 5;

std::string_view name(StopState state);  // "asked", as in device/shrc203/README.md
inline bool is_open(StopState state) { return state == StopState::asked || state == StopState::written; }

struct Stop {
  static constexpr std::size_t kCallersNamed = 8;

  StopId id = 0;
  StopKind kind = StopKind::stop;
  AxisSet axes;  // all for an emergency stop
  StopState state = StopState::asked;
  std::vector<std::string> callers{};  // in the order of their requests, each once; the first kCallersNamed
  std::string serial_number{};         // of the controller that is to stop; empty if it was never connected
  TimePoint asked{}, ended{};
  bool late = false;                      // a caller was notified that it stays open
  bool stale = false;                     // the axes rest, but a prebuffer still holds a segment that could start
  StopId replaced_by = 0;                 // if replaced
  std::string withdrawn_by{};             // if withdrawn
  std::map<int, std::int64_t> came_to{};  // if confirmed: the command counter at which each axis rests
};

// "stop of axes 1 and 2", "emergency stop".
std::string title_of(const Stop& stop);

// Forbids all motion of a device, from an emergency stop until ClearErrors for all axes.
struct EmergencyLatch {
  std::string who;
  TimePoint at{};
};

}  // namespace axisgate::stage
