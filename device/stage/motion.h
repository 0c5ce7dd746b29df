// A motion: one thing that a caller asked the stage to do, from the asking to its outcome.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/stage/axes.h"

namespace axisgate::stage {

using MotionId = std::uint64_t;  // 0 is none; of each device they ascend

enum class MotionKind { move, home, return_to_origin, path, execute, jog, scan };

// queued: accepted, its starting line not yet written. running: the controller accepted the start.
// An outcome is one of the last four, and unknown is said when it is so.
enum class MotionState { queued, running, stopping, succeeded, stopped, failed, unknown };

inline bool is_outcome(MotionState state) { return state >= MotionState::succeeded; }

struct AxisResult {
  int axis = 0;
  std::optional<std::int64_t> target_pulses;   // in the frame of the start; nothing before it is known
  std::optional<std::int64_t> command_pulses;  // the command counter at the end
  bool completion_seen = false;                // the completion was received
};

// What a scan came to, in drive pulses of the axis.
struct ScanResult {
  std::int64_t run_from = 0, run_to = 0;  // where it started its run, and where it stopped
  // Trigger pulses due in the whole run and in its range; of scale pulses nothing where the scale's are not known.
  std::optional<std::int64_t> expected, expected_in_range;
  std::optional<std::int64_t> observed;  // by the distance that the counter was seen to travel; nothing before the end
};

struct Motion {
  MotionId id = 0;
  MotionKind kind = MotionKind::move;
  MotionState state = MotionState::queued;
  AxisSet axes;
  std::vector<AxisResult> results;  // one per axis, ascending
  std::optional<Problem> problem;   // why it failed, was stopped or is unknown
  bool written = false;             // a line of its own has gone out, so that its start may have
  std::string who;                  // the caller
  std::string request_id;
  TimePoint created{}, started{}, ended{};
  std::optional<TimePoint> due;  // it should be over by then; nothing where that is not known
  int segments_total = 0;        // a path's
  int segments_done = 0;
  int underruns = 0;
  std::optional<ScanResult> scan;
};

// What others wait for, as they are shown it.
struct Occupation {
  std::string by;                // "move by unix bert"
  std::string before, after;     // of what stands in parentheses: "axis 1 is in motion 1312", ""
  std::optional<TimePoint> due;  // it should be over by then; nothing where that is not known
};
// "axis 1 is in motion 1312 (move by unix bert, 4 s left)".
std::string text_of(const Occupation& occupation, TimePoint now);
Occupation occupation_by(const Motion& motion);

std::string_view name(MotionKind kind);    // "move", "home", "return-to-origin", "path", "execute", "jog", "scan"
std::string_view name(MotionState state);  // "QUEUED", "RUNNING", ...

}  // namespace axisgate::stage
