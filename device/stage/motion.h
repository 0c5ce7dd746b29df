// A motion: one request to move, from its acceptance to its outcome.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/stage/axes.h"
#include "device/use/occupation.h"

namespace axisgate::stage {

using MotionId = std::uint64_t;  // 0: none; ascending for each device

enum class MotionKind { move, home, return_to_origin, path, execute, jog, scan };

// queued: accepted, but the starting line is not written yet. running: the controller has accepted the start. The last
// four are outcomes; the outcome unknown is reported as such.
enum class MotionState { queued, running, stopping, succeeded, stopped, failed, unknown };

inline bool is_outcome(MotionState state) { return state >= MotionState::succeeded; }

struct AxisResult {
  int axis = 0;
  std::optional<std::int64_t> target_pulses;   // in the frame at the start; nullopt if unknown
  std::optional<std::int64_t> command_pulses;  // the command counter at the end
  bool completion_seen = false;
};

// Result of a scan, in drive pulses of the axis.
struct ScanResult {
  std::int64_t run_from = 0, run_to = 0;  // start and end of the run
  std::optional<std::int64_t> interval;   // between two trigger pulses, in drive pulses, signed; nullopt: scale pulses
  // Trigger pulses due in the whole run and in its range; nullopt for scale pulses if the scale's resolution is
  // unknown.
  std::optional<std::int64_t> expected, expected_in_range;
  std::optional<std::int64_t> observed;  // computed from the distance that the counter moved; nullopt before the end
};

struct Motion {
  MotionId id = 0;
  MotionKind kind = MotionKind::move;
  MotionState state = MotionState::queued;
  AxisSet axes;
  std::vector<AxisResult> results;  // one per axis, ascending
  std::optional<Problem> problem;   // reason for failure, stop, or unknown outcome
  bool written = false;             // a line of this motion was sent, so it may have started
  std::string who;
  std::string request_id;
  TimePoint created{}, started{}, ended{};
  std::optional<TimePoint> due;  // expected end; nullopt if unknown
  int segments_total = 0;        // of a path
  int segments_done = 0;
  int underruns = 0;
  std::optional<ScanResult> scan;
};

use::Occupation occupation_by(const Motion& motion);

std::string_view name(MotionKind kind);    // "move", "home", "return-to-origin", "path", "execute", "jog", "scan"
std::string_view name(MotionState state);  // "QUEUED", "RUNNING", ...

}  // namespace axisgate::stage
