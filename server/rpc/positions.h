// Saved positions as callers name and read them, and what a controller must tell of one before it is gone to.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "axisgate/v1/position.pb.h"
#include "device/core/problem.h"
#include "device/stage/kind.h"
#include "server/devices/saved_positions.h"
#include "server/gateway.h"

namespace axisgate::rpc {

namespace api = axisgate::v1;

struct PositionName {
  server::Device* device = nullptr;
  std::string name;
};
// invalid_request where it is not "devices/{d}/positions/{name}", unknown_device.
Result<PositionName> find_position_name(const server::Gateway& gateway, std::string_view name);

// The position, or not_found.
Result<server::SavedPosition> find_position(const server::SavedPositions& positions, const PositionName& name);

// epoch_passed where another controller than the present one holds it.
Result<void> check_unit(const server::SavedPosition& position, const stage::State& state);

api::Position to_proto(const server::SavedPosition& position, const stage::State& state);

stage::PositionSlot slot_of(const server::SavedPosition& position);

// By axis, of the answers to `question` for it, sent twice. device_refused, line_fault.
Result<std::map<int, std::int64_t>> coordinates_told(const server::SavedPosition& position, const std::string& question,
                                                     const std::vector<std::string>& answers, const stage::Kind& kind,
                                                     const stage::State& state);

// What the controller must tell, by axis; empty: it may tell anything, but must hold it.
std::map<int, std::int64_t> expected_of(const server::SavedPosition& position, const stage::State& state);

// Why a motion to it was refused, in its caller's words.
Problem refusal_of(Problem problem, const server::SavedPosition& position, const stage::State& state, TimePoint now);

}  // namespace axisgate::rpc
