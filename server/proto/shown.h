// Positions of a stage in the units in which the configuration shows them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "axisgate/v1/common.pb.h"
#include "device/core/quantity.h"
#include "device/stage/state.h"
#include "server/devices/stage.h"

namespace axisgate::proto {

// Returns the position as an exact decimal in the unit. Empty if the position is unknown, or if the unit does not fit
// the scale.
std::string position_text(std::optional<std::int64_t> pulses, const std::optional<Scale>& scale, Unit unit);

// A Shown has the names, units and present scales of one stage's axes.
class Shown {
 public:
  // `stage` must outlive this object. Null: a stage that is configured no longer, whose texts are empty.
  explicit Shown(const server::Stage* stage);

  // Sets `name` and `unit` of a message about an axis.
  template <class Message>
  void describe(int axis, Message& message) const {
    if (stage_ == nullptr) return;
    message.set_name(stage_->profile().axis(axis).name);
    message.set_unit(unit(axis));
  }
  std::string text(int axis, std::optional<std::int64_t> pulses) const;

 private:
  v1::Unit unit(int axis) const;

  const server::Stage* stage_;
  std::shared_ptr<const stage::State> state_;
};

}  // namespace axisgate::proto
