// A stop, from its request until its axes are confirmed stationary, and the latch that an emergency stop sets.
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

using StopId = std::uint64_t;  // 0: none; ascending for each device

enum class StopKind { stop, emergency };

enum class StopState {
  asked,      // not written yet: the line is closed, or the controller accepts no stop in its mode
  written,    // written at least once; repeated until the axes are confirmed stationary
  confirmed,  // after it was written, the axes were stationary and their prebuffers empty
  replaced,   // replaced by a wider stop, which answers its callers
  withdrawn,  // withdrawn by an administrator, since the controller will not come back
};
inline constexpr std::size_t kStopStates = 5;

std::string_view name(StopState state);  // "asked"
inline bool is_open(StopState state) { return state == StopState::asked || state == StopState::written; }

struct Stop {
  static constexpr std::size_t kCallersNamed = 8;

  StopId id = 0;
  StopKind kind = StopKind::stop;
  AxisSet axes;  // all axes for an emergency stop
  StopState state = StopState::asked;
  std::vector<std::string> callers{};  // in the order of their requests, each once; at most kCallersNamed
  std::string serial_number{};         // serial number of the controller to stop; empty if it was never connected
  TimePoint asked{}, ended{};
  bool late = false;           // a caller was notified that the stop stays open
  bool stale = false;          // the axes are stationary, but a prebuffer still contains a segment that could start
  StopId replaced_by = 0;      // for StopState::replaced
  std::string withdrawn_by{};  // for StopState::withdrawn
  std::map<int, std::int64_t> came_to{};  // for StopState::confirmed: command counter of each axis after the stop
};

// "stop of axes 1 and 2", "emergency stop".
std::string title_of(const Stop& stop);

// An EmergencyLatch forbids all motion of a device, from an emergency stop until ClearErrors for all axes.
struct EmergencyLatch {
  std::string who;
  TimePoint at{};
};

}  // namespace axisgate::stage
