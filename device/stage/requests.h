// What callers may ask of a stage controller, and what it reports of it.
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
#include "device/stage/arc.h"
#include "device/stage/axes.h"
#include "device/stage/motion.h"
#include "device/stage/stop.h"

namespace axisgate::stage {

// Who asks, and until when the asking counts. `not_after` bounds when a motion may start and how long a question may
// wait; it never stops what has started.
struct RequestContext {
  std::string who;
  std::string request_id{};
  TimePoint not_after{};
  std::uint64_t lease = 0;               // its fencing token; 0: none
  std::uint64_t device_epoch = 0;        // State::device_epoch that the caller has in mind; 0: any
  std::uint64_t frame_epoch = 0;         // the same of State::frame_epoch
  std::string role{};                    // a word of the configuration, "operator": for the travel envelope
  std::optional<TimePoint> answer_by{};  // of a stop: its report is made by then, of what is known
  std::string identity{};                // as whom `who` takes turns with others; empty: as `who`
  std::string session{};                 // Use::session

  const std::string& takes_turns_as() const { return identity.empty() ? who : identity; }
};

// S, F and R of an axis (manual 89) D:): speeds 1 to 1,000,000 pulses/s, S <= F, R 1 to 1,000 ms.
struct SpeedProfile {
  Quantity minimum;
  Quantity maximum;
  int acceleration_ms = 100;
};

struct AxisMove {
  int axis = 0;
  Quantity distance;  // a target, or a displacement when the request is relative
  std::optional<SpeedProfile> profile;
  std::optional<Quantity> approach{};  // the approach to the target, whatever side it is on; not 0
};

struct MoveRequest {
  std::vector<AxisMove> moves;  // each axis once
  bool relative = false;
  RequestContext context;
};

// Mechanical origin return (manual 60) HRT:) or return to the logical origin (62) ZRT:).
struct HomeRequest {
  AxisSet axes;  // empty: all controllable axes
  RequestContext context;
};

// A circle, an arc or a helix (manual 71) to 82)). Amounts of two axes stand in the order of `axes`.
struct Curve {
  struct Around {
    std::array<Quantity, 2> center;
    Rotation rotation = Rotation::clockwise;
    std::variant<int, Decimal> extent = 1;  // whole turns, or degrees
  };
  struct Through {
    std::array<Quantity, 2> point, end;
  };
  std::array<int, 2> axes{};  // ascending
  std::variant<Around, Through> course;
  std::optional<Quantity> rise;  // what axis 3 goes in one turn, or in all of less than one turn
};

// One stretch of a path. Several axes: a straight line or a curve, always relative on the wire. One axis: relative or
// absolute. The same axes in every segment.
struct Segment {
  std::vector<AxisMove> moves;
  bool relative = true;           // ways from where the segment begins, instead of places
  std::optional<Quantity> speed;  // path speed of a line or curve (its lower axis's S), or one axis's maximum speed F
  std::optional<int> acceleration_ms;
  std::optional<Curve> curve{};  // instead of moves
  Duration rest{};               // at READY before it, 0 to kRestMax
  std::optional<int> inputs{};   // at READY before it, until I: shows them; 0 to 63

  static constexpr Duration kRestMax = std::chrono::milliseconds(255'000);
};

// One axis over a range at constant speed, with a trigger pulse every `interval` pulses.
struct ScanRequest {
  int axis = 0;
  Quantity from, to;              // places
  std::optional<Quantity> speed;  // F; nothing: as set
  std::optional<int> acceleration_ms;
  bool by_scale = false;  // the interval is of scale pulses, in the direction of the scan
  std::int64_t interval = 0;
  RequestContext context;
};

// To a position that the controller keeps (manual 131) PIT:GRT, 136) PAV:GRT).
struct GoToPositionRequest {
  bool place = true;  // PIT:, else PAV:
  int number = 0;     // 1 to 20
  // What the controller must report that it holds, by axis; anything else is refused with epoch_passed. Empty:
  // anything, but not nothing. For a place whose coordinates may have changed since, or been recomputed (manual 129)).
  std::map<int, std::int64_t> expected;
  RequestContext context;
};

struct PathRequest {
  static constexpr std::size_t kSegmentsMax = 100'000;
  std::vector<Segment> segments;
  RequestContext context;
};

// Axes that run until they are stopped: J: (manual 88)). The caller says again and again that they shall.
struct JogRequest {
  struct Axis {
    int axis = 0;
    int direction = 1;              // or -1
    std::optional<Quantity> speed;  // per second (93) JD:); nothing: S
  };
  std::vector<Axis> axes;  // each once
  RequestContext context;
};

struct StopReport {
  struct Axis {
    int axis = 0;
    std::string wire_reply;         // OK, NG, or empty: no answer, or none that can be believed
    bool named = false;             // an axis without excitation is not named: L: would be refused (manual 65))
    bool reply_unreadable = false;  // an answer came, and is none
    std::optional<bool> ready;
    std::optional<std::int64_t> position_pulses;
  };
  std::vector<Axis> axes;
  std::optional<Problem> problem;  // outcome_unknown, wrong_mode, stale_setpoint ...
  StopId stop = 0;                 // 0: none was needed, or of a mill
  bool stays_open = false;         // it is repeated until the axes are seen stationary
};

// What became of the motions that there were when the gateway began to end.
struct WindDownReport {
  std::vector<Motion> motions;     // with their outcomes
  std::optional<Problem> problem;  // of the stop: not written, or the axes were not confirmed stationary
};

struct ExecuteRequest {
  std::vector<std::string> lines;  // one transaction: nobody else's motion comes between
  RequestContext context;
};

// A transaction's events, in order: each line's reply, then each completion it caused, then the end.
struct ExecuteEvent {
  enum class Kind { reply, completion, ended };
  Kind kind = Kind::reply;
  std::size_t line = 0;    // index into the request's lines
  std::string answer;      // the requested field, OK, NG ...
  std::string sent;        // what was really sent
  std::string wire_reply;  // what really came
  int axis = 0;            // a completion's
  std::optional<Problem> problem;
};

}  // namespace axisgate::stage
