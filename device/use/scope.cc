#include "device/use/scope.h"

namespace axisgate::use {

std::vector<int> Scope::list() const {
  std::vector<int> numbers;
  for (std::uint32_t bits = axes(), axis = 1; bits != 0; bits >>= 1, ++axis) {
    if ((bits & 1u) != 0) numbers.push_back(static_cast<int>(axis));
  }
  return numbers;
}

std::string to_string(Scope scope) {
  if (scope.is_whole_device()) return "the whole device";
  const std::vector<int> list = scope.list();
  if (list.empty()) return "no axis";
  std::string text = list.size() == 1 ? "axis " : "axes ";
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i > 0) text += i + 1 == list.size() ? " and " : ", ";
    text += std::to_string(list[i]);
  }
  return text;
}

}  // namespace axisgate::use
