// Checks of a saved position against the controller's report, and the reasons of refusals.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/kind.h"
#include "server/devices/saved_positions.h"

namespace axisgate::api {

// Fails with epoch_passed if the position is in another controller than the present one.
Result<void> check_unit(const server::SavedPosition& position, const stage::State& state);

// Reports whether the controller may have lost the position.
bool may_be_lost(const server::SavedPosition& position, const stage::State& state);

stage::PositionSlot slot_of(const server::SavedPosition& position);

// Returns the coordinates by axis, from the answers to `question`, which was sent twice. Fails with device_refused or
// line_fault.
Result<std::map<int, std::int64_t>> reported_coordinates(const server::SavedPosition& position,
                                                         const std::string& question,
                                                         const std::vector<std::string>& answers,
                                                         const stage::Kind& kind, const stage::State& state);

// Returns the coordinates that the controller must report, by axis. Empty: it must have the position, but may report
// any coordinates.
std::map<int, std::int64_t> expected_of(const server::SavedPosition& position, const stage::State& state);

// Returns the reason why a motion to the position was refused, worded for its caller.
Problem refusal_of(Problem problem, const server::SavedPosition& position, const stage::State& state, TimePoint now);

}  // namespace axisgate::api
