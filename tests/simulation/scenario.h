// What the hazard tests have in common: a good line, requests in one call, and what came of them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/simulation/world.h"

namespace axisgate::simulation {

// A perfect line at 38400 baud and the simulator's usual readings.
Setup quiet();
// The same, with `permission` to decide who may move what.
Setup shared_by(stage::Permission& permission);

inline constexpr stage::AxisSet kOne = stage::AxisSet::of(1), kTwo = stage::AxisSet::of(2);

using Ways = std::vector<std::pair<int, std::int64_t>>;  // axis, pulses
stage::MoveRequest move_of(const World& world, const Ways& ways, bool relative);
void move_by(World& world, const Ways& ways);
void move_for(World& world, const std::string& who, const Ways& ways);

// Why a move by `ways` is refused at once; unspecified if it is not.
Reason refusal_of(World& world, const Ways& ways);

// A straight line of axes 1 and 2: -1000 and 2000 by turns of axis 1, 2000 each of axis 2, a tenth of a second each.
stage::PathRequest line_of(const World& world, int segments);
void home(World& world, stage::AxisSet axes);
Reason reason_of(const stage::Motion& motion);  // unspecified when there is no problem

// Both run the world to an answer; a motion's outcome at most `limit` later.
std::vector<std::string> execute(World& world,
                                 std::vector<std::string> lines);  // replies, "completion 1", a problem's name
stage::Motion outcome_of(World& world, std::size_t number, Duration limit = std::chrono::seconds(30));

// A move by `ways` that has succeeded.
void moved(World& world, const Ways& ways);
// A stop of all axes and what was reported of it.
stage::StopReport stopped(World& world, Duration limit = std::chrono::seconds(60));

// The lines on the wire from `first` on that begin with `prefix`.
int written(World& world, std::string_view prefix, std::size_t first = 0);
// HRT ZRT M A MP AP KP G and the like: what sets a motion or starts it.
int motion_lines(World& world, std::size_t first);

// The lines from `first` on that set a prebuffer, in their order.
std::vector<std::string> prebuffer_lines(World& world, std::size_t first = 0);

// Something else speaks to the device while the gateway's line is unplugged, which then comes back.
void foreign_traffic(World& world, const std::vector<std::string>& lines);

// Drops the first line of that kind that begins with `prefix`; for a reply, `prefix` is the command's that it answers.
Script drop_first(World& world, LineKind kind, std::string prefix);

}  // namespace axisgate::simulation
