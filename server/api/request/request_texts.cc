#include "server/api/request/request_texts.h"

#include <fmt/format.h>

#include "device/core/quantity.h"

namespace axisgate::api {
namespace {

std::string text_of(const Quantity& quantity) {
  return fmt::format("{} {}", to_string(quantity.value), symbol(quantity.unit));
}

std::string joined(std::string_view verb, const std::vector<std::string>& parts) {
  return fmt::format("{} {}", verb, fmt::join(parts, ", "));
}

}  // namespace

std::string text_of(const stage::MoveRequest& move) {
  std::vector<std::string> axes;
  for (const stage::AxisMove& one : move.moves) {
    axes.push_back(fmt::format("axis {} {} {}", one.axis, move.relative ? "by" : "to", text_of(one.distance)));
  }
  return joined("move", axes);
}

std::string text_of(const stage::ScanRequest& scan) {
  return fmt::format("scan axis {} from {} to {}", scan.axis, text_of(scan.from), text_of(scan.to));
}

std::string text_of(const stage::JogRequest& jog) {
  std::vector<std::string> axes;
  for (const stage::JogRequest::Axis& one : jog.axes) {
    const std::string speed = one.speed ? text_of(*one.speed) + "/s" : "its minimum speed";
    axes.push_back(fmt::format("axis {} {} at {}", one.axis, one.direction > 0 ? "plus" : "minus", speed));
  }
  return joined("jog", axes);
}

std::string text_of(std::string_view verb, stage::AxisSet axes) {
  return fmt::format("{} {}", verb, axes.empty() ? "all axes" : to_string(axes));
}

std::string text_of(std::string_view verb, const std::vector<std::string>& lines) {
  return fmt::format("{}: {}", verb, fmt::join(lines, " | "));
}

}  // namespace axisgate::api
