// What a move comes to in pulses, checked against units, travel and speed limits before anything is sent.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/command/reply.h"
#include "device/shrc203/stage.h"
#include "device/stage/envelope.h"

namespace axisgate::shrc203 {

struct AxisPlan {
  int axis = 0;
  std::int64_t amount = 0;             // as sent: a way or a target
  std::optional<std::int64_t> target;  // nothing where a relative move's start is not known
  std::optional<SpeedSetting> speed;   // to be sent with the move
};

struct MovePlan {
  bool relative = false;
  std::vector<AxisPlan> axes;  // ascending
  AxisSet set() const;
};

// What is to be sent, and the speeds to be sent with it, by axis.
std::map<int, std::int64_t> amounts_of(const MovePlan& plan);
std::map<int, SpeedSetting> speeds_of(const MovePlan& plan);
// out_of_range outside 1 to 1000 ms.
Result<void> check_acceleration(int axis, int milliseconds);

// Where the axes stand when the motion begins; nothing for an axis that nobody knows.
using Positions = std::array<std::optional<std::int64_t>, kAxisCount>;
Positions positions_of(const State& state);

// What the envelope refuses, not_representable, out_of_range, invalid_request. Where `from` does not know an axis, its
// relative way is not checked against the travel limits.
Result<MovePlan> plan_move(const std::vector<AxisMove>& moves, bool relative, const Positions& from,
                           const Envelope& envelope);

}  // namespace axisgate::shrc203
