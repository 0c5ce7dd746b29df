// A move in pulses, checked against units, travel and speed limits before anything is sent.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "device/core/problem.h"
#include "device/shot/command/reply.h"
#include "device/shrc203/stage.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

struct AxisPlan {
  int axis = 0;
  std::int64_t amount = 0;             // as sent: displacement or target
  std::optional<std::int64_t> target;  // nullopt for a relative move from an unknown position
  std::optional<SpeedSetting> speed;   // speeds to send with the move
};

struct MovePlan {
  bool relative = false;
  std::vector<AxisPlan> axes;  // ascending
  AxisSet set() const;
};

// Return the amounts to send, and the speeds to send with them, by axis.
std::map<int, std::int64_t> amounts_of(const MovePlan& plan);
std::map<int, SpeedSetting> speeds_of(const MovePlan& plan);
// Fails with out_of_range outside 1 to 1000 ms.
Result<void> check_acceleration(int axis, int milliseconds);

// Positions of the axes when the motion begins; nullopt if unknown.
using Positions = std::array<std::optional<std::int64_t>, kAxisCount>;
Positions positions_of(const State& state);

// Plans a move. Fails as the envelope does, or with not_representable, out_of_range or invalid_request. If `from` does
// not know an axis, its relative displacement is not checked against the travel limits.
Result<MovePlan> plan_move(const std::vector<AxisMove>& moves, bool relative, const Positions& from,
                           const Envelope& envelope);

}  // namespace axisgate::shrc203
