#include "device/shrc203/planning/arc_lines.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "device/shrc203/planning/transaction_lines.h"

namespace axisgate::shrc203 {
namespace {

// Returns the coordinates of a line by letter, in pulses of their axes.
Result<std::map<std::string, std::int64_t>> coordinates_of(const Command& command, const std::array<int, 3>& axes,
                                                           const Envelope& envelope) {
  static const std::map<std::string, std::size_t> kAxisOf = {{"c1", 0}, {"p1", 0}, {"e1", 0}, {"c2", 1},
                                                             {"p2", 1}, {"e2", 1}, {"z", 2}};
  std::map<std::string, std::int64_t> coordinates;
  std::int64_t sign = 1;
  Unit unit = Unit::pulses;
  for (const auto& [letter, value] : command.arguments.values()) {
    if (letter == "m") sign = value == "-" ? -1 : 1;
    if (letter == "u") unit = unit_of(value);
    const auto axis = kAxisOf.find(letter);
    if (axis == kAxisOf.end()) continue;
    Decimal amount = *parse_decimal(value);
    amount.digits *= sign;
    const auto pulses = envelope.pulses(axes[axis->second], {amount, unit});
    if (!pulses) return tl::unexpected(pulses.error());
    coordinates[letter] = *pulses;
  }
  return coordinates;
}

Extent joined(const Extent& one, const Extent& other) {
  return {std::min(one.lowest, other.lowest), std::max(one.highest, other.highest)};
}

}  // namespace

Result<ArcLine> arc_of(const Command& command, const Envelope& envelope) {
  const auto plane = from_command_letter(command.arguments.first("a")->front(), kAllAxes)->list();
  ArcLine line{{}, {plane[0], plane[1], command.row->third_axis ? 3 : 0}, {}};
  for (const int axis : line.axes) {
    if (axis == 0) continue;
    if (const auto good = envelope.check_axis(axis); !good) return tl::unexpected(good.error());
  }
  const auto known = coordinates_of(command, line.axes, envelope);
  if (!known) return tl::unexpected(known.error());
  const auto at = [&](const char* letter) { return known->contains(letter) ? known->at(letter) : 0; };
  const auto number = [&](std::string_view letter) { return std::stod(command.arguments.first(letter).value_or("0")); };
  const PlanePoint center{at("c1"), at("c2")}, passing{at("p1"), at("p2")}, end{at("e1"), at("e2")};
  const Rotation rotation = command.arguments.first("d") == "0" ? Rotation::clockwise : Rotation::counterclockwise;
  Result<Arc> arc;
  switch (*command.row->curve) {
    case CurveForm::circle:
      arc = whole_circle(center, rotation);
      break;
    case CurveForm::arc_by_angle:
      arc = arc_by_angle(center, number("ae"), rotation);
      break;
    case CurveForm::arc_through:
      arc = arc_through(passing, end);
      break;
    case CurveForm::helix_of_turns:
      arc = helix_of_turns(center, static_cast<int>(number("n")), rotation, at("z"));
      break;
    case CurveForm::helix_by_angle:
      arc = helix_by_angle(center, number("ae"), rotation, at("z"));
      break;
    case CurveForm::helix_through:
      arc = helix_through(passing, end, at("z"));
  }
  if (!arc) return tl::unexpected(arc.error());
  line.arc = *arc;
  line.extent = extent_of(*arc);
  const bool by_point = command.arguments.first("p1").has_value();
  if (!by_point || rotation_of(*arc) == rotation) return line;
  const auto other = other_way(*arc);
  if (!other) return tl::unexpected(other.error());
  const ArcExtent rest = extent_of(*other);
  line.extent = {joined(line.extent.first, rest.first), joined(line.extent.second, rest.second),
                 joined(line.extent.third, rest.third)};
  return line;
}

Result<void> check_scales(AxisSet axes, const State& state) {
  const auto& first = *state.axis(axes.lowest()).scale;
  if (std::ranges::all_of(axes.list(), [&](int axis) { return *state.axis(axis).scale == first; })) return {};
  return fail(Reason::invalid_request, "a line or curve of several axes needs pulses that are equally long",
              "move these axes one after the other");
}

}  // namespace axisgate::shrc203
