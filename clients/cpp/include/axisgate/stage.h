// The connection to a stage, and what a program does with it.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <ranges>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "axisgate/events.h"
#include "axisgate/jog.h"
#include "axisgate/lease.h"
#include "axisgate/motion.h"
#include "axisgate/places.h"
#include "axisgate/results.h"
#include "axisgate/state.h"
#include "axisgate/units.h"

namespace axisgate {

namespace client {
class DeviceSession;
}

// Address of a daemon, and how to call it. An empty text means the environment variable in parentheses.
struct ConnectOptions {
  std::string device = {};       // name of the stage; empty: the only one
  std::string target = {};       // path of a Unix socket, or HOST[:PORT] (AXISGATE_TARGET); empty: the local daemon
  std::string token = {};        // token of the caller (AXISGATE_TOKEN)
  std::string ca = {};           // file with the authority of the daemon's certificate, for TLS (AXISGATE_CA)
  std::string certificate = {};  // file with the caller's certificate (AXISGATE_CERTIFICATE)
  std::string key = {};          // file with the key of the certificate (AXISGATE_KEY)
  std::chrono::milliseconds timeout{10000};        // longest time until a call fails if no daemon answers
  std::function<void(std::string_view)> log = {};  // receives one line for each call, from any thread
};

// Positions or displacements by the names or numbers of their axes.
using Targets = std::map<std::string, Distance, std::less<>>;
// One position for each axis of a path, in the order of the axes.
using Point = std::vector<Distance>;

// MoveOptions are terms of a move, for all its axes.
struct MoveOptions {
  std::optional<Speed> speed = {};  // highest speed; nullopt: the present speed profile of the axis
  // Displacement of the last part of the move, whose direction is then always the same, so that backlash does not
  // matter. nullopt: the axis moves directly.
  std::optional<Distance> approach = {};
  std::stop_token stop = {};  // cancels the move of a call that waits for the outcome
};

// ScanTerms are the terms of a scan.
struct ScanTerms {
  std::string axis;
  Distance start, end;
  Distance every;                   // distance between two trigger pulses
  std::optional<Speed> speed = {};  // constant; nullopt: the present F of the axis
};

// SpeedTerms are the speed profile of an axis. nullopt leaves a part as it is.
struct SpeedTerms {
  std::optional<Speed> minimum = {};                           // S, at which a motion begins and ends
  std::optional<Speed> maximum = {};                           // F
  std::optional<std::chrono::milliseconds> acceleration = {};  // R, the time from S to F: 1 ms to 1 s
};

// Lines in the controller's own language, and what they resulted in.
struct Executed {
  std::vector<std::string> replies;  // one for each line
  std::optional<Motion> motion;      // the motion that the lines started
};

// The caller as the daemon identifies it.
struct CallerIdentity {
  std::string name;  // "unix anna"
  std::string role;  // "observer", "operator" or "admin"
};

class Axis;

// A Stage is the connection to one device that moves axes. Axes are named as in the configuration, or by their numbers:
// "x", "1". Copies share the connection, which closes with the last of them; motions continue then. All functions are
// thread safe. Every function throws Refused if the daemon refuses a request: nothing moved.
class AXISGATE_PUBLIC Stage {
 public:
  // Connects to the daemon. Throws Unavailable if no daemon answers, and InvalidArgument if there is no such stage, or
  // the options contradict each other.
  explicit Stage(const ConnectOptions& options = {});

  // Returns the names of the daemon's stages.
  static std::vector<std::string> find(const ConnectOptions& options = {});

  std::string name() const;
  // Returns the axes that can be moved, in the order of their numbers.
  std::vector<Axis> axes() const;
  // Returns an axis by its name or number. Throws InvalidArgument if there is none.
  Axis operator[](std::string_view axis) const;
  CallerIdentity whoami() const;

  // Returns the state of the device, which is read from the controller if it is older than `max_age`. nullopt: any age.
  Status status(std::optional<std::chrono::milliseconds> max_age = std::nullopt) const;
  // Begins a series of states, at most one in each interval.
  States watch(std::chrono::milliseconds interval = std::chrono::milliseconds(50)) const;
  // Begins a series of events: with new events, or after an event.
  Events events() const;
  Events events_after(const Event& last) const;
  // Begins a series of events with a revision. 0: all kept events.
  Events events_from(std::uint64_t revision) const;
  // Returns the newest 100 motions, newest first, also those of other callers.
  std::vector<Motion> motions() const;

  // Checks a move as far as possible without moving. Throws Refused if it would be refused.
  void check(const Targets& targets, const MoveOptions& options = {}) const;
  // Starts a move of axes to positions, or by displacements from the present positions, all at once.
  Motion start(const Targets& targets, const MoveOptions& options = {}) const;
  Motion start_by(const Targets& displacements, const MoveOptions& options = {}) const;
  // Moves axes, and waits for the outcome. Throws Refused, Stopped, MotionFailed or OutcomeUnknown; after
  // `options.stop`, which cancels the move, Interrupted.
  MotionResult move_to(const Targets& targets, const MoveOptions& options = {}) const;
  MotionResult move_by(const Targets& displacements, const MoveOptions& options = {}) const;
  // Homes axes, without names all, and waits for the outcome. `stop` cancels the motion.
  MotionResult home(const std::vector<std::string>& axes = {}, std::stop_token stop = {}) const;
  // Does the same as home() for those of the axes that the daemon has not homed yet. The result has no positions if
  // there are none.
  MotionResult home_if_needed(const std::vector<std::string>& axes = {}, std::stop_token stop = {}) const;

  // Starts a path through points without a halt. All points are read first, so nothing moves if reading them throws.
  template <std::ranges::input_range Points>
  Motion path(Points&& points, const std::vector<std::string>& axes, const std::optional<Speed>& speed = {}) const {
    std::vector<Point> all;
    for (auto&& point : points) all.emplace_back(std::begin(point), std::end(point));
    return start_path(all, axes, speed);
  }
  // Moves to one point after another, and calls `arrived` once the axes are stationary at each point. Use it under a
  // lease, so that nobody moves the axes in between.
  template <std::ranges::input_range Points>
  void visit(Points&& points, const std::vector<std::string>& axes,
             const std::function<void(const MotionResult&)>& arrived, const MoveOptions& options = {}) const {
    for (auto&& point : points) arrived(move_to(targets_at(axes, Point(std::begin(point), std::end(point))), options));
  }
  // Starts a run of one axis at constant speed. The trigger output gives a pulse every `every`, from `start` on.
  Motion scan(const ScanTerms& terms) const;
  // Runs axes until the end of the Jog. A negative speed is one in the minus direction.
  Jog jog(const std::map<std::string, Speed, std::less<>>& speeds) const;
  // Sends lines in the controller's own language, once, as one transaction. Throws Refused if nothing moved; otherwise
  // Stopped, MotionFailed or OutcomeUnknown.
  Executed execute(const std::vector<std::string>& lines) const;

  // Slows down and stops axes, without names all of the stage. Needs no lease. Returns what was seen within 4 s. The
  // stop has a connection of its own; it is sent again for half of the timeout if no daemon answers. Throws
  // OutcomeUnknown if it could not be delivered. Not a safety function.
  StopReport stop(const std::vector<std::string>& axes = {}) const;
  // Stops all axes at once without slowing down. Nothing moves until clear_errors(). Not a safety function.
  StopReport emergency_stop() const;
  // Clears limit, overflow and emergency errors of axes, without names of all. Starts no motion.
  void clear_errors(const std::vector<std::string>& axes = {}) const;
  // Allows motion after a stop by another caller. Returns the numbers of the axes that may move again.
  std::vector<int> rearm() const;

  // Switches the current of a motor. Without current, the axis can be moved by hand.
  void switch_motor(std::string_view axis, bool on) const;
  // Sets the speed profile of an axis. Under a lease, the earlier profile is restored after the lease.
  void set_speeds(std::string_view axis, const SpeedTerms& speeds) const;

  // Acquires the exclusive right to axes. Throws LeaseHeld if they are not free.
  Lease lease(const LeaseTerms& terms = {}) const;
  Places places() const;

 private:
  Motion start_path(const std::vector<Point>& points, const std::vector<std::string>& axes,
                    const std::optional<Speed>& speed) const;
  static Targets targets_at(const std::vector<std::string>& axes, const Point& point);

  std::shared_ptr<client::DeviceSession> session_;
};

// An Axis is one axis of a Stage, and shares its connection.
class AXISGATE_PUBLIC Axis {
 public:
  Axis(Stage stage, std::string name, int number, std::string unit)
      : stage_(std::move(stage)), name_(std::move(name)), number_(number), unit_(std::move(unit)) {}

  const std::string& name() const noexcept { return name_; }  // from the configuration, or the number as text
  int number() const noexcept { return number_; }             // from 1
  const std::string& unit() const noexcept { return unit_; }  // unit of the positions

  // Read from the controller.
  AxisState state() const;
  Position position() const { return state().position; }

  // See the functions of Stage.
  Motion start(const Distance& target, const MoveOptions& options = {}) const;
  Motion start_by(const Distance& displacement, const MoveOptions& options = {}) const;
  MotionResult move_to(const Distance& target, const MoveOptions& options = {}) const;
  MotionResult move_by(const Distance& displacement, const MoveOptions& options = {}) const;
  MotionResult home(std::stop_token stop = {}) const;
  StopReport stop() const;

 private:
  Stage stage_;
  std::string name_;
  int number_;
  std::string unit_;
};

}  // namespace axisgate
