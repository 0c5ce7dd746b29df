// Common parts of the hazard tests: a good line, requests in one call, and their results.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tests/simulation/world.h"

namespace axisgate::simulation {

// Returns a perfect line at 38400 baud with the simulator's default interpretations.
Setup quiet();
// Returns the same with `permission`, which decides who may move which axes.
Setup shared_by(use::Permission& permission);

inline constexpr stage::AxisSet kOne = stage::AxisSet::of(1), kTwo = stage::AxisSet::of(2);

using Ways = std::vector<std::pair<int, std::int64_t>>;  // axis, pulses
stage::MoveRequest move_of(const World& world, const Ways& ways, bool relative);
void move_by(World& world, const Ways& ways);
void move_for(World& world, const std::string& who, const Ways& ways);

// Returns the reason for which a move by `ways` is refused at once; unspecified if it is not.
Reason refusal_of(World& world, const Ways& ways);

// Returns a straight line of axes 1 and 2: -1000 and 2000 in turn for axis 1, 2000 each for axis 2, a tenth of a second
// each.
stage::PathRequest line_of(const World& world, int segments);
void home(World& world, stage::AxisSet axes);
Reason reason_of(const stage::Motion& motion);  // unspecified if there is no problem

// Run the world until the answer, or until the motion's outcome, at most for `limit`.
std::vector<std::string> execute(World& world,
                                 std::vector<std::string> lines);  // replies, "completion 1", a problem's name
stage::Motion outcome_of(World& world, std::size_t number, Duration limit = std::chrono::seconds(30));

// Moves by `ways` and expects success.
void moved(World& world, const Ways& ways);
// Stops all axes and returns the report.
stage::StopReport stopped(World& world, Duration limit = std::chrono::seconds(60));

// Counts the lines sent from index `first` on that begin with `prefix`.
int written(World& world, std::string_view prefix, std::size_t first = 0);
// Counts the lines that set or start a motion: HRT ZRT M A MP AP KP G and similar.
int motion_lines(World& world, std::size_t first);

// Returns the lines from index `first` on that set a prebuffer, in order.
std::vector<std::string> prebuffer_lines(World& world, std::size_t first = 0);

// Sends lines from another program while the gateway's line is unplugged, and then plugs it in again.
void foreign_traffic(World& world, const std::vector<std::string>& lines);

// Drops the first line of a kind that begins with `prefix`. A reply is chosen by the command that it answers.
Script drop_first(World& world, LineKind kind, std::string prefix);

}  // namespace axisgate::simulation
