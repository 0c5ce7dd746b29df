// What a controller must report of a saved position before it is moved to, and why it was refused otherwise.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "device/core/problem.h"
#include "device/stage/kind.h"
#include "server/devices/saved_positions.h"

namespace axisgate::api {

// epoch_passed where another controller than the present one holds it.
Result<void> check_unit(const server::SavedPosition& position, const stage::State& state);

// Whether the controller may hold it no more.
bool may_be_lost(const server::SavedPosition& position, const stage::State& state);

stage::PositionSlot slot_of(const server::SavedPosition& position);

// By axis, of the answers to `question` for it, sent twice. device_refused, line_fault.
Result<std::map<int, std::int64_t>> reported_coordinates(const server::SavedPosition& position,
                                                         const std::string& question,
                                                         const std::vector<std::string>& answers,
                                                         const stage::Kind& kind, const stage::State& state);

// What the controller must report, by axis; empty: it may report anything, but must hold it.
std::map<int, std::int64_t> expected_of(const server::SavedPosition& position, const stage::State& state);

// Why a motion to it was refused, in its caller's words.
Problem refusal_of(Problem problem, const server::SavedPosition& position, const stage::State& state, TimePoint now);

}  // namespace axisgate::api
