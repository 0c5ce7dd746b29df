#include "axisgate/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <ostream>

#include "axisgate/state.h"

namespace axisgate {
namespace {

std::string joined(const auto& items) {
  std::string text;
  for (const auto& item : items) text += (text.empty() ? "" : ", ") + item.text();
  return text;
}

}  // namespace

std::optional<double> Position::number() const {
  return value.empty() ? std::nullopt : std::optional(std::strtod(value.c_str(), nullptr));
}

std::string Position::text() const {
  return value.empty() ? axis + " unknown" : fmt::format("{} {} {}", axis, value, unit);
}

const Position& MotionResult::position(std::string_view axis) const {
  const auto found = std::ranges::find(positions, axis, &Position::axis);
  if (found == positions.end()) throw InvalidArgument(fmt::format("the motion has no axis {}", axis));
  return *found;
}

std::string MotionResult::text() const { return joined(positions); }

std::string AxisStop::text() const {
  const char* const state = !stationary ? "not seen stationary" : *stationary ? "stationary" : "still moving";
  return fmt::format("{} ({})", position.text(), state);
}

std::string StopReport::text() const {
  return joined(axes) + (stays_open ? "; the stop stays open" : "") +
         (problem ? std::string(": ") + problem->what() : "");
}

const AxisState& Status::axis(std::string_view name) const {
  const auto found = std::ranges::find(known_axes(), name, &AxisState::name);
  if (found == axes.end()) throw InvalidArgument(fmt::format("{} has no axis {}", device, name));
  return *found;
}

const std::vector<AxisState>& Status::known_axes() const {
  if (!axes.empty()) return axes;
  throw Unavailable({.reason = "LINK_DOWN",
                     .message = fmt::format("the axes of {} are unknown: {}", device,
                                            link_problem.empty() ? "the controller is read" : link_problem),
                     .hint = "wait until the controller answers"});
}

std::string Status::text() const {
  std::vector<Position> positions;
  for (const AxisState& axis : axes) positions.push_back(axis.position);
  return fmt::format("{} {}: {}", device, link, link_problem.empty() ? joined(positions) : link_problem);
}

std::ostream& operator<<(std::ostream& stream, const Position& position) { return stream << position.text(); }
std::ostream& operator<<(std::ostream& stream, const MotionResult& result) { return stream << result.text(); }
std::ostream& operator<<(std::ostream& stream, const AxisStop& stop) { return stream << stop.text(); }
std::ostream& operator<<(std::ostream& stream, const StopReport& report) { return stream << report.text(); }
std::ostream& operator<<(std::ostream& stream, const Status& status) { return stream << status.text(); }

}  // namespace axisgate
