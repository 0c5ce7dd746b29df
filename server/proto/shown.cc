#include "server/proto/shown.h"

#include "server/proto/amounts.h"

namespace axisgate::proto {

std::string position_text(std::optional<std::int64_t> pulses, const std::optional<Scale>& scale, Unit unit) {
  if (!pulses || (unit != Unit::pulses && !scale)) return "";
  const Result<Decimal> shown = from_pulses(*pulses, unit, scale.value_or(Scale{}));
  return shown ? to_string(*shown) : "";
}

Shown::Shown(const server::Stage* stage) : stage_(stage) {
  if (stage != nullptr) state_ = stage->newest_state().get().value;
}

std::string Shown::text(int axis, std::optional<std::int64_t> pulses) const {
  if (stage_ == nullptr) return "";
  return position_text(pulses, state_->axis(axis).scale, stage_->profile().axis(axis).unit);
}

v1::Unit Shown::unit(int axis) const { return to_proto(stage_->profile().axis(axis).unit); }

}  // namespace axisgate::proto
