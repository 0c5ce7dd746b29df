#include "clients/axisctl/condition_text.h"

#include <fmt/format.h>

#include "device/stage/condition.h"

namespace axisgate::axisctl {

std::string condition_text(v1::Condition condition, const google::protobuf::RepeatedField<std::int32_t>& axes,
                           bool begun, const std::string& value) {
  stage::AxisSet set;
  for (const int axis : axes) set.add(axis);
  return stage::words(static_cast<stage::Condition>(condition), set, begun, value);
}

std::string status_text(const v1::Axis& axis) {
  std::string text;
  for (const int condition : axis.conditions()) {
    text += (text.empty() ? "" : ", ") + stage::words(static_cast<stage::Condition>(condition));
  }
  return text.empty() ? "normal" : text;
}

std::string between_text(const std::string& before, const std::string& seen) {
  return before == seen ? "at " + seen : fmt::format("between {} and {}", before, seen);
}

std::string found_text(const std::string& seen) { return fmt::format("found at {}, by the first reading", seen); }

}  // namespace axisgate::axisctl
