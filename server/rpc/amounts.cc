#include "server/rpc/amounts.h"

#include <fmt/format.h>

#include <string>

namespace axisgate::rpc {
namespace {

Result<Quantity> decimal(const std::string& text, Unit unit) {
  const Result<Decimal> value = parse_decimal(text);
  if (!value) return tl::unexpected(value.error());
  return Quantity{*value, unit};
}

// Pulses come as a Decimal from the configuration, where "5.0" is whole, too.
std::int64_t whole(const Quantity& quantity) { return to_pulses(quantity, Scale{}).value_or(0); }

}  // namespace

Result<Quantity> to_quantity(const api::Distance& distance) {
  switch (distance.amount_case()) {
    case api::Distance::kPulses:
      return pulses(distance.pulses());
    case api::Distance::kNm:
      return decimal(distance.nm(), Unit::nanometers);
    case api::Distance::kUm:
      return decimal(distance.um(), Unit::micrometers);
    case api::Distance::kMm:
      return decimal(distance.mm(), Unit::millimeters);
    case api::Distance::kDegrees:
      return decimal(distance.degrees(), Unit::degrees);
    case api::Distance::AMOUNT_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "a distance has no amount", "set one of pulses, nm, um, mm and degrees");
}

Result<Quantity> to_quantity(const api::Speed& speed) {
  switch (speed.amount_case()) {
    case api::Speed::kPulsesPerS:
      return pulses(speed.pulses_per_s());
    case api::Speed::kNmPerS:
      return decimal(speed.nm_per_s(), Unit::nanometers);
    case api::Speed::kUmPerS:
      return decimal(speed.um_per_s(), Unit::micrometers);
    case api::Speed::kMmPerS:
      return decimal(speed.mm_per_s(), Unit::millimeters);
    case api::Speed::kDegreesPerS:
      return decimal(speed.degrees_per_s(), Unit::degrees);
    case api::Speed::AMOUNT_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "a speed has no amount",
              "set one of pulses_per_s, nm_per_s, um_per_s, mm_per_s and degrees_per_s");
}

api::Distance to_distance(const Quantity& quantity) {
  api::Distance distance;
  switch (quantity.unit) {
    case Unit::pulses:
      distance.set_pulses(whole(quantity));
      break;
    case Unit::nanometers:
      distance.set_nm(to_string(quantity.value));
      break;
    case Unit::micrometers:
      distance.set_um(to_string(quantity.value));
      break;
    case Unit::millimeters:
      distance.set_mm(to_string(quantity.value));
      break;
    case Unit::degrees:
      distance.set_degrees(to_string(quantity.value));
      break;
  }
  return distance;
}

api::Speed to_speed(const Quantity& quantity) {
  api::Speed speed;
  switch (quantity.unit) {
    case Unit::pulses:
      speed.set_pulses_per_s(whole(quantity));
      break;
    case Unit::nanometers:
      speed.set_nm_per_s(to_string(quantity.value));
      break;
    case Unit::micrometers:
      speed.set_um_per_s(to_string(quantity.value));
      break;
    case Unit::millimeters:
      speed.set_mm_per_s(to_string(quantity.value));
      break;
    case Unit::degrees:
      speed.set_degrees_per_s(to_string(quantity.value));
      break;
  }
  return speed;
}

api::Unit to_proto(Unit unit) {
  static_assert(static_cast<int>(Unit::pulses) + 1 == api::UNIT_PULSES);
  static_assert(static_cast<int>(Unit::degrees) + 1 == api::UNIT_DEGREES);
  return static_cast<api::Unit>(static_cast<int>(unit) + 1);
}

Result<int> to_axis(int number) {
  if (number >= 1 && number <= stage::kAxisCount) return number;
  return fail(Reason::unknown_axis, fmt::format("there is no axis {}", number), "axes are 1, 2 and 3");
}

Result<stage::AxisSet> to_axes(const google::protobuf::RepeatedField<google::protobuf::int32>& numbers) {
  stage::AxisSet axes;
  for (const int number : numbers) {
    const Result<int> axis = to_axis(number);
    if (!axis) return tl::unexpected(axis.error());
    if (axes.has(*axis)) return fail(Reason::invalid_request, fmt::format("axis {} is named twice", number));
    axes.add(*axis);
  }
  return axes;
}

}  // namespace axisgate::rpc
