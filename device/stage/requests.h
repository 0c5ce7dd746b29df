// Requests that callers make to a stage controller, and the reports that answer them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "device/core/problem.h"
#include "device/core/quantity.h"
#include "device/core/time.h"
#include "device/stage/axes.h"
#include "device/stage/motion.h"
#include "device/stage/stop.h"
#include "device/use/request_context.h"

namespace axisgate::stage {

// Speeds of an axis: it starts and ends at the minimum, and reaches the maximum after the acceleration time. The
// minimum is at most the maximum. The kind sets the ranges.
struct SpeedProfile {
  Quantity minimum;
  Quantity maximum;
  int acceleration_ms = 100;
};

struct AxisMove {
  int axis = 0;
  Quantity distance;  // target position, or displacement if the request is relative
  std::optional<SpeedProfile> profile;
  std::optional<Quantity> approach{};  // displacement of the last part of the move, always in this direction; not 0
};

struct MoveRequest {
  std::vector<AxisMove> moves;  // at most one per axis
  bool relative = false;
  use::RequestContext context;
};

// Mechanical origin return, or return to the logical origin.
struct HomeRequest {
  AxisSet axes;  // empty: all controllable axes
  use::RequestContext context;
};

// Direction of a curve, seen with the first axis pointing right and the second one up.
enum class Rotation { clockwise, counterclockwise };

// A circle, an arc or a helix. Values for two axes are in the order of `axes`.
struct Curve {
  struct Around {
    std::array<Quantity, 2> center;
    Rotation rotation = Rotation::clockwise;
    std::variant<int, Decimal> extent = 1;  // number of turns, or degrees
  };
  struct Through {
    std::array<Quantity, 2> point, end;
  };
  std::array<int, 2> axes{};  // ascending
  std::variant<Around, Through> course;
  std::optional<Quantity> rise;  // rise of axis 3 per turn, or in total for less than one turn
};

// A Segment is one piece of a path. Several axes: a straight line or a curve, always relative on the line. One axis:
// relative or absolute. All segments of a path have the same axes.
struct Segment {
  std::vector<AxisMove> moves;
  bool relative = true;  // displacements from the segment's start, instead of positions
  std::optional<Quantity>
      speed;  // path speed of a line or curve (minimum speed of its lowest axis), or maximum speed of a single axis
  std::optional<int> acceleration_ms;
  std::optional<Curve> curve{};  // instead of moves
  Duration rest{};               // pause at READY before the segment, 0 to kRestMax
  std::optional<int> inputs{};   // input pattern to wait for at READY before the segment, as bits; 0 to 63

  static constexpr Duration kRestMax = std::chrono::milliseconds(255'000);
};

// A ScanRequest runs one axis over a range at constant speed, with a trigger pulse every `interval` pulses.
struct ScanRequest {
  int axis = 0;
  Quantity from, to;              // positions
  std::optional<Quantity> speed;  // maximum speed; nullopt: unchanged
  std::optional<int> acceleration_ms;
  bool by_scale = false;  // interval in scale pulses, in the direction of the scan
  std::int64_t interval = 0;
  use::RequestContext context;
};

// A GoToPositionRequest moves to a position saved in the controller.
struct GoToPositionRequest {
  bool place = true;  // true: a place of the stage; false: coordinates
  int number = 0;     // 1 to 20
  // Expected saved coordinates by axis; a different report is refused with epoch_passed. Empty: any coordinates, but
  // the position must be saved. Used for a place whose coordinates may have changed or been recomputed since.
  std::map<int, std::int64_t> expected;
  use::RequestContext context;
};

struct PathRequest {
  static constexpr std::size_t kSegmentsMax = 100'000;
  std::vector<Segment> segments;
  use::RequestContext context;
};

// A JogRequest runs axes until they are stopped. The caller renews it again and again.
struct JogRequest {
  struct Axis {
    int axis = 0;
    int direction = 1;              // 1 or -1
    std::optional<Quantity> speed;  // per second; nullopt: the minimum speed
  };
  std::vector<Axis> axes;  // at most one per axis
  use::RequestContext context;
};

struct StopReport {
  struct Axis {
    int axis = 0;
    std::string wire_reply;         // OK or NG; empty: no answer, or no trustworthy one
    bool named = false;             // named in the stop's line; not if its motor is off
    bool reply_unreadable = false;  // an answer came, but it was unreadable
    std::optional<bool> ready;
    std::optional<std::int64_t> position_pulses;
  };
  std::vector<Axis> axes;
  std::optional<Problem> problem;  // outcome_unknown, wrong_mode, stale_setpoint ...
  StopId stop = 0;                 // 0: no stop was needed, or the device is a mill
  bool stays_open = false;         // the stop is repeated until the axes are confirmed stationary
};

// A WindDownReport has the outcomes of the motions that existed when the gateway began to end.
struct WindDownReport {
  std::vector<Motion> motions;     // with their outcomes
  std::optional<Problem> problem;  // problem of the stop: not written, or the axes were not confirmed stationary
};

struct ExecuteRequest {
  std::vector<std::string> lines;  // lines of one transaction: no other caller's motion comes between them
  use::RequestContext context;
};

// An event of a transaction, in order: each line's reply, then each completion that the line caused, then the end.
struct ExecuteEvent {
  enum class Kind { reply, completion, ended, motion };  // `motion` comes first, if at all
  Kind kind = Kind::reply;
  std::size_t line = 0;    // index into the request's lines
  std::string answer;      // the requested field, OK, NG ...
  std::string sent;        // line as sent
  std::string wire_reply;  // reply as received
  int axis = 0;            // axis of a completion
  MotionId motion = 0;     // the motion of the lines
  std::optional<Problem> problem;
};

}  // namespace axisgate::stage
