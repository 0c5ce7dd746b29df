// Checks of the users at every line sent.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "device/shot/command/axes.h"
#include "tests/simulation/users.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using simulator::AxisSetup;
using std::chrono::milliseconds;

bool moves_something(const std::string& line) { return sets_motion(line) || starts_motion(line); }

// Returns the axes of a motion's line, from the letter after the colon.
AxisSet axes_of(const std::string& line) {
  const auto colon = line.find(':');
  const auto axes = from_command_letter(line[colon + 1], kAllAxes);
  return axes.value_or(AxisSet());
}

}  // namespace

// Checks that every line that sets or starts a motion is from the owner of its axes, or that they have no owner; and
// that its author is not latched.
void Users::check_bytes(const BytesWritten& written) {
  check_speeds(written);
  check_outputs(written);
  if (written.exchange == 0 || !moves_something(written.bytes)) return;
  for (const int axis : axes_of(written.bytes).list()) {
    const Grant* owner = owner_of(axis);
    if (owner && owner->who != written.who) {
      world_.violation(fmt::format("{} of {} went out for axis {}, which {} owns", written.bytes.substr(0, 6),
                                   written.who, axis, owner->who));
    }
    const bool latched = (owner && owner->latched.has(axis)) || std::ranges::any_of(grants_, [&](const auto& entry) {
                           return entry.second.who == written.who && entry.second.latched_by_others.has(axis);
                         });
    const auto held_back = held_back_.find(written.who);
    if (latched || (held_back != held_back_.end() && held_back->second.has(axis))) {
      world_.violation(fmt::format("{} of {} went out for axis {}, which was stopped and not rearmed",
                                   written.bytes.substr(0, 6), written.who, axis));
    }
  }
}

// Checks that a caller who moves at the controller's own speeds finds the earlier speeds, unless the same caller has
// set others. A damaged bit of a line may have set others, and so may a damaged value that was read.
void Users::check_speeds(const BytesWritten& written) {
  if (world_.wire().damaged_since(TimePoint{})) return;
  const bool sets_speed = written.bytes.find("F4000R50") != std::string::npos;
  const bool at_given_speed = written.bytes.starts_with("J:") || written.bytes.find(",S") != std::string::npos;
  if (!sets_speed && (!sets_motion(written.bytes) || at_given_speed)) return;
  for (const int axis : axes_of(written.bytes).list()) {
    bool sped = false;
    for (auto& [token, grant] : grants_) {
      if (grant.who != written.who || !grant.axes.has(axis)) continue;
      grant.sped = grant.sped || sets_speed;
      sped = sped || grant.sped;
    }
    if (sped || world_.device().maximum_speed(axis) == AxisSetup().maximum_speed) continue;
    world_.violation(fmt::format("{} moves axis {} at {} pulses/s, which another has set", written.who, axis,
                                 world_.device().maximum_speed(axis)));
  }
}

// Checks the same for outputs and the trigger, which only a holder of the whole controller sets here.
void Users::check_outputs(const BytesWritten& written) {
  if (world_.wire().damaged_since(TimePoint{})) return;
  const bool sets = written.bytes.starts_with("O:") || written.bytes.starts_with("T:");
  if (!sets && !moves_something(written.bytes)) return;
  bool wired = false;
  for (auto& [token, grant] : grants_) {
    if (grant.who != written.who || grant.axes != kAllAxes) continue;
    grant.wired = grant.wired || sets;
    wired = wired || grant.wired;
  }
  const bool untouched = world_.device().outputs() == 0 && world_.device().trigger() == "NS";
  if (wired || untouched || written.who.starts_with("the gateway")) return;
  world_.violation(fmt::format("{} meets outputs {} and trigger {}, which another has set", written.who,
                               world_.device().outputs(), world_.device().trigger()));
}

// Checks that a jog is stopped within the limit if its caller stops renewing it; one time step of the simulation is
// allowed.
void Users::check_jogs() {
  for (const Motion& motion : world_.controller().motions()) {
    const auto renewed = renewed_.find(motion.id);
    if (renewed == renewed_.end() || motion.state != MotionState::running) continue;
    if (world_.now() <= renewed->second + Controller::kJogSilence) continue;
    world_.violation(fmt::format("jog {} of {} runs on after {} ms of silence", motion.id, motion.who,
                                 (world_.now() - renewed->second) / milliseconds(1)));
  }
}

// Checks the travel, unless a command was damaged: a wrong bit may move an axis anywhere.
void Users::check_travel() {
  if (world_.wire().commands_damaged() > 0) return;
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    if (std::abs(world_.device().position(axis)) > kTravel) {
      world_.violation(fmt::format("axis {} is at {}, outside its travel", axis, world_.device().position(axis)));
    }
  }
}

}  // namespace axisgate::simulation
