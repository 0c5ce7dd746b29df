#include "server/proto/curves.h"

#include <fmt/format.h>
#include <google/protobuf/repeated_field.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "server/api/stage/targets.h"
#include "server/proto/amounts.h"

namespace axisgate::proto {
namespace {

using api::AxisNames;
using stage::Curve;
using stage::Rotation;

constexpr int kHelixAxis = 3;  // manual 74) to 76), 80) to 82): z

struct PlanePlace {
  std::array<int, 2> axes{};  // ascending
  std::array<Quantity, 2> amounts;
};

std::string named(const std::array<int, 2>& axes) { return fmt::format("axes {} and {}", axes[0], axes[1]); }

// `what` is the subject of the error messages, such as "the center".
Result<PlanePlace> to_place(const google::protobuf::RepeatedPtrField<v1::AxisDistance>& parts, const AxisNames& names,
                            std::string_view what) {
  if (parts.size() != 2) {
    return fail(Reason::invalid_request, fmt::format("{} of an arc has two coordinates, not {}", what, parts.size()),
                "name both axes of the circle once; a third axis goes into `rise`");
  }
  std::array<std::pair<int, Quantity>, 2> found;
  for (int i = 0; i < 2; ++i) {
    const Result<int> axis = names.find(parts[i].axis());
    if (!axis) return tl::unexpected(axis.error());
    const Result<Quantity> amount = to_quantity(parts[i].distance());
    if (!amount) return tl::unexpected(api::on_axis(*axis, amount.error()));
    found[static_cast<std::size_t>(i)] = {*axis, *amount};
  }
  if (found[0].first == found[1].first) {
    return fail(Reason::invalid_request, fmt::format("{} of an arc names axis {} twice", what, found[0].first),
                "name both axes of the circle once");
  }
  if (found[0].first > found[1].first) std::swap(found[0], found[1]);
  return PlanePlace{{found[0].first, found[1].first}, {found[0].second, found[1].second}};
}

Result<Rotation> to_rotation(v1::ArcAroundCenter::Rotation rotation) {
  switch (rotation) {
    case v1::ArcAroundCenter::ROTATION_CLOCKWISE:
      return Rotation::clockwise;
    case v1::ArcAroundCenter::ROTATION_COUNTERCLOCKWISE:
      return Rotation::counterclockwise;
    default:
      return fail(Reason::invalid_request, "an arc around a center does not say which way round it goes",
                  "set `rotation` to clockwise or counterclockwise");
  }
}

Result<std::variant<int, Decimal>> to_extent(const v1::ArcAroundCenter& around) {
  switch (around.extent_case()) {
    case v1::ArcAroundCenter::kTurns:
      return around.turns();
    case v1::ArcAroundCenter::kDegrees: {
      const Result<Decimal> degrees = parse_decimal(around.degrees());
      if (!degrees) return tl::unexpected(degrees.error());
      return *degrees;
    }
    case v1::ArcAroundCenter::EXTENT_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "an arc around a center does not say how far it goes",
              "set `turns` or `degrees`");
}

Result<Curve> to_around(const v1::ArcAroundCenter& around, const AxisNames& names) {
  const Result<PlanePlace> center = to_place(around.center(), names, "the center");
  if (!center) return tl::unexpected(center.error());
  const Result<Rotation> rotation = to_rotation(around.rotation());
  if (!rotation) return tl::unexpected(rotation.error());
  const Result<std::variant<int, Decimal>> extent = to_extent(around);
  if (!extent) return tl::unexpected(extent.error());
  return Curve{center->axes, Curve::Around{center->amounts, *rotation, *extent}, {}};
}

Result<Curve> to_through(const v1::ArcThroughPoint& through, const AxisNames& names) {
  const Result<PlanePlace> point = to_place(through.point(), names, "the point");
  if (!point) return tl::unexpected(point.error());
  const Result<PlanePlace> end = to_place(through.end(), names, "the end");
  if (!end) return tl::unexpected(end.error());
  if (point->axes != end->axes) {
    return fail(Reason::invalid_request,
                fmt::format("an arc goes through a point of {} to an end of {}", named(point->axes), named(end->axes)),
                "name the same two axes in both");
  }
  return Curve{point->axes, Curve::Through{point->amounts, end->amounts}, {}};
}

Result<Quantity> to_rise(const v1::AxisDistance& rise, const AxisNames& names) {
  const Result<int> axis = names.find(rise.axis());
  if (!axis) return tl::unexpected(axis.error());
  if (*axis != kHelixAxis) {
    return fail(Reason::invalid_request, fmt::format("a helix rises along axis 3, not along axis {}", *axis),
                "the controller's helices are circles of axes 1 and 2 while axis 3 goes along");
  }
  const Result<Quantity> amount = to_quantity(rise.distance());
  if (!amount) return tl::unexpected(api::on_axis(kHelixAxis, amount.error()));
  return *amount;
}

}  // namespace

Result<Curve> to_curve(const v1::Arc& arc, const AxisNames& names) {
  if (arc.course_case() == v1::Arc::COURSE_NOT_SET) {
    return fail(Reason::invalid_request, "an arc has no course", "set `around` or `through`");
  }
  Result<Curve> curve = arc.has_around() ? to_around(arc.around(), names) : to_through(arc.through(), names);
  if (!curve || !arc.has_rise()) return curve;
  const Result<Quantity> rise = to_rise(arc.rise(), names);
  if (!rise) return tl::unexpected(rise.error());
  curve->rise = *rise;
  return curve;
}

}  // namespace axisgate::proto
