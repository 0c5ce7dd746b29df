#include "server/api/request/axis_names.h"

#include <fmt/format.h>

#include <charconv>
#include <string>

#include "device/core/escape.h"
#include "server/api/request/names.h"
#include "server/gateway.h"

namespace axisgate::api {

Result<int> AxisNames::find(std::string_view number_or_name) const {
  int number = 0;
  const char* const end = number_or_name.data() + number_or_name.size();
  if (std::from_chars(number_or_name.data(), end, number).ptr == end && number >= 1 && number <= stage::kAxesMax) {
    return number;
  }
  std::string names;
  for (int axis = 1; profile_ != nullptr && axis <= stage::kAxesMax; ++axis) {
    const std::string& name = profile_->axis(axis).name;
    if (name.empty()) continue;
    if (name == number_or_name) return axis;
    names += fmt::format("{}{} is axis {}", names.empty() ? "" : ", ", name, axis);
  }
  return fail(Reason::unknown_axis, fmt::format("there is no axis \"{}\"", escaped(number_or_name)),
              names.empty() ? "axes are numbered from 1" : names);
}

Result<stage::AxisSet> AxisNames::find_all(const std::vector<std::string_view>& numbers_or_names) const {
  stage::AxisSet axes;
  for (const std::string_view one : numbers_or_names) {
    const Result<int> axis = find(one);
    if (!axis) return tl::unexpected(axis.error());
    if (axes.has(*axis)) return fail(Reason::invalid_request, fmt::format("axis {} is named twice", *axis));
    axes.add(*axis);
  }
  return axes;
}

AxisNames axis_names(const server::Gateway& gateway, std::string_view device) {
  if (device.empty()) {
    return gateway.stages().size() == 1 ? AxisNames(&gateway.stages().front()->profile()) : AxisNames();
  }
  const Result<server::Stage*> found = find_stage(gateway, device);
  return found ? AxisNames(&(*found)->profile()) : AxisNames();
}

}  // namespace axisgate::api
