#include "device/shrc203/planning/curve_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

#include "device/shrc203/command/builders.h"
#include "device/shrc203/planning/arc_lines.h"

namespace axisgate::shrc203 {
namespace {

// Converts points of a curve to pulses from its start.
class Places {
 public:
  Places(const Curve& curve, bool relative, const Positions& from, const Envelope& envelope)
      : curve_(curve), relative_(relative), from_(from), envelope_(envelope) {}

  Result<PlanePoint> at(const std::array<Quantity, 2>& amounts) const {
    std::array<std::int64_t, 2> pulses{};
    for (std::size_t i = 0; i < amounts.size(); ++i) {
      const auto amount = envelope_.pulses(curve_.axes[i], amounts[i]);
      if (!amount) return tl::unexpected(amount.error());
      pulses[i] = relative_ ? *amount : *amount - *from_[static_cast<std::size_t>(curve_.axes[i] - 1)];
    }
    return PlanePoint{pulses[0], pulses[1]};
  }

 private:
  const Curve& curve_;
  bool relative_;
  const Positions& from_;
  const Envelope& envelope_;
};

void add_place(Arguments& arguments, std::string_view letter, std::int64_t pulses) {
  arguments.add("m", pulses < 0 ? "-" : "+").add("u", "P").add(letter, std::to_string(std::abs(pulses)));
}

Arguments begin(const Curve& curve, Rotation rotation) {
  return Arguments()
      .axes(AxisSet::of(curve.axes[0]) | AxisSet::of(curve.axes[1]))
      .add("d", rotation == Rotation::clockwise ? "0" : "1");
}

Result<CurvePlan> by_turns(const Curve& curve, const Curve::Around& around, PlanePoint center,
                           std::optional<std::int64_t> rise) {
  const int turns = std::get<int>(around.extent);
  CurvePlan plan{{}, rise ? CurveForm::helix_of_turns : CurveForm::circle, begin(curve, around.rotation)};
  if (!rise && turns != 1) {
    return fail(Reason::out_of_range,
                fmt::format("a circle of {} turns; the controller makes one (manual 71) E:0)", turns),
                "repeat the segment");
  }
  if (rise) plan.arguments.add("n", std::to_string(turns));
  add_place(plan.arguments, "c1", center.first);
  add_place(plan.arguments, "c2", center.second);
  if (!rise) {
    plan.arc = whole_circle(center, around.rotation);
    return plan;
  }
  add_place(plan.arguments, "z", *rise);
  const auto arc = helix_of_turns(center, turns, around.rotation, *rise);
  if (!arc) return tl::unexpected(arc.error());
  plan.arc = *arc;
  return plan;
}

Result<CurvePlan> by_angle(const Curve& curve, const Curve::Around& around, PlanePoint center,
                           std::optional<std::int64_t> rise) {
  const std::string angle = to_string(std::get<Decimal>(around.extent));
  const double degrees = std::stod(angle);
  const auto arc =
      rise ? helix_by_angle(center, degrees, around.rotation, *rise) : arc_by_angle(center, degrees, around.rotation);
  if (!arc) return tl::unexpected(arc.error());
  CurvePlan plan{*arc, rise ? CurveForm::helix_by_angle : CurveForm::arc_by_angle, begin(curve, around.rotation)};
  add_place(plan.arguments, "c1", center.first);
  add_place(plan.arguments, "c2", center.second);
  plan.arguments.add("ae", angle);
  if (rise) add_place(plan.arguments, "z", *rise);
  return plan;
}

// The direction sent matches the passing point, so it does not matter which of the two the controller follows.
Result<CurvePlan> through(const Curve& curve, PlanePoint point, PlanePoint end, std::optional<std::int64_t> rise) {
  const auto arc = rise ? helix_through(point, end, *rise) : arc_through(point, end);
  if (!arc) return tl::unexpected(arc.error());
  CurvePlan plan{*arc, rise ? CurveForm::helix_through : CurveForm::arc_through, begin(curve, rotation_of(*arc))};
  add_place(plan.arguments, "p1", point.first);
  add_place(plan.arguments, "p2", point.second);
  add_place(plan.arguments, "e1", end.first);
  add_place(plan.arguments, "e2", end.second);
  if (rise) add_place(plan.arguments, "z", *rise);
  return plan;
}

Result<CurvePlan> plan_line(const Curve& curve, const Places& places, std::optional<std::int64_t> rise) {
  if (const auto* course = std::get_if<Curve::Through>(&curve.course)) {
    const auto point = places.at(course->point);
    if (!point) return tl::unexpected(point.error());
    const auto end = places.at(course->end);
    if (!end) return tl::unexpected(end.error());
    return through(curve, *point, *end, rise);
  }
  const auto& around = std::get<Curve::Around>(curve.course);
  const auto center = places.at(around.center);
  if (!center) return tl::unexpected(center.error());
  if (*center == PlanePoint{}) {
    return fail(Reason::invalid_request, "the center is where the curve begins, so that it has no radius",
                "give the center of the circle, seen from its beginning");
  }
  return std::holds_alternative<int>(around.extent) ? by_turns(curve, around, *center, rise)
                                                    : by_angle(curve, around, *center, rise);
}

Result<void> check_axes(const Curve& curve, AxisSet axes, const Positions& from, const Envelope& envelope) {
  if (curve.axes[0] >= curve.axes[1]) {
    return fail(Reason::invalid_request, "a curve lies in the plane of two axes, each named once");
  }
  if (curve.rise && curve.axes != std::array{1, 2}) {
    return fail(Reason::invalid_request, "a helix turns in axes 1 and 2, and axis 3 goes along (manual 74) E:3)");
  }
  for (const int axis : axes.list()) {
    Result<void> good = envelope.check_axis(axis);
    if (good) good = envelope.check_homed(axis);
    if (!good) return good;
    if (from[static_cast<std::size_t>(axis - 1)]) continue;
    return envelope.position_unknown(axis);
  }
  return check_scales(axes, envelope.state());
}

}  // namespace

std::int64_t slack_of(const CurvePlan& curve) {
  const bool by_angle = curve.arguments.first("ae").has_value();
  return by_angle && !ends_on_whole_pulses(curve.arc) ? 1 : 0;
}

double share_of_speed(const Arc& arc, bool third_axis) {
  return third_axis ? std::abs(arc.rise) / std::max(1.0, length_of(arc)) : 1;
}

Result<PlannedCurve> plan_curve(const Curve& curve, bool relative, const Positions& from, std::int64_t slack,
                                const Envelope& envelope) {
  AxisSet axes;
  for (const int axis : curve.axes) {
    if (auto good = envelope.check_axis(axis); !good) return tl::unexpected(good.error());
    axes.add(axis);
  }
  if (curve.rise) axes.add(kAxisCount);
  if (auto good = check_axes(curve, axes, from, envelope); !good) return tl::unexpected(good.error());
  std::optional<std::int64_t> rise;
  if (curve.rise) {
    const auto pulses = envelope.pulses(kAxisCount, *curve.rise);
    if (!pulses) return tl::unexpected(pulses.error());
    rise = *pulses;
  }
  auto planned = plan_line(curve, Places(curve, relative, from, envelope), rise);
  if (!planned) return tl::unexpected(planned.error());
  if (auto line = commands::set_curve(planned->form, planned->arguments); !line) {
    return tl::unexpected(line.error());
  }
  const ArcEnd end = end_of(planned->arc);
  const ArcExtent extent = extent_of(planned->arc);
  const std::array<std::int64_t, kAxisCount> ways = {end.first, end.second, end.third};
  const std::array<Extent, kAxisCount> reaches = {extent.first, extent.second, extent.third};
  MovePlan move{true, {}};
  std::size_t place = 0;
  for (const int axis : axes.list()) {
    const std::int64_t at = *from[static_cast<std::size_t>(axis - 1)];
    const std::int64_t beside = slack + slack_of(*planned);
    for (const std::int64_t reached : {reaches[place].lowest - beside, reaches[place].highest + beside}) {
      if (auto good = envelope.check_target(axis, at + reached); !good) return tl::unexpected(good.error());
    }
    move.axes.push_back({axis, ways[place], at + ways[place], {}});
    ++place;
  }
  return PlannedCurve{*std::move(planned), std::move(move)};
}

}  // namespace axisgate::shrc203
