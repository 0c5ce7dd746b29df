#include "device/stage/axes.h"

namespace axisgate::stage {

std::vector<int> AxisSet::list() const {
  std::vector<int> axes;
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    if (has(axis)) axes.push_back(axis);
  }
  return axes;
}

std::string to_string(AxisSet axes) {
  const std::vector<int> list = axes.list();
  if (list.empty()) return "no axis";
  std::string text = list.size() == 1 ? "axis " : "axes ";
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i > 0) text += i + 1 == list.size() ? " and " : ", ";
    text += std::to_string(list[i]);
  }
  return text;
}

}  // namespace axisgate::stage
