#include "server/proto/amounts.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "server/limits.h"

namespace axisgate::proto {
namespace {

Result<Quantity> decimal(const std::string& text, Unit unit) {
  const Result<Decimal> value = parse_decimal(text);
  if (!value) return tl::unexpected(value.error());
  return Quantity{*value, unit};
}

Result<Quantity> floating(const v1::FloatingAmount& amount) {
  if (amount.unit() < v1::UNIT_PULSES || amount.unit() > v1::UNIT_DEGREES) {
    return fail(Reason::invalid_request, "an amount has no unit", "set one of UNIT_PULSES to UNIT_DEGREES");
  }
  const bool nearest = amount.rounding() == v1::ROUNDING_NEAREST;
  const Result<Decimal> value = decimal_of(amount.value(), nearest);
  if (!value) return tl::unexpected(value.error());
  return Quantity{*value, static_cast<Unit>(amount.unit() - v1::UNIT_PULSES), nearest};
}

// The configuration's pulses are Decimals, and there "5.0" is a whole number too.
std::int64_t whole(const Quantity& quantity) { return to_pulses(quantity, Scale{}).value_or(0); }

}  // namespace

Result<Quantity> to_quantity(const v1::Distance& distance) {
  switch (distance.amount_case()) {
    case v1::Distance::kPulses:
      return pulses(distance.pulses());
    case v1::Distance::kNm:
      return decimal(distance.nm(), Unit::nanometers);
    case v1::Distance::kUm:
      return decimal(distance.um(), Unit::micrometers);
    case v1::Distance::kMm:
      return decimal(distance.mm(), Unit::millimeters);
    case v1::Distance::kDegrees:
      return decimal(distance.degrees(), Unit::degrees);
    case v1::Distance::kFloating:
      return floating(distance.floating());
    case v1::Distance::AMOUNT_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "a distance has no amount",
              "set one of pulses, nm, um, mm, degrees and floating");
}

Result<Quantity> to_quantity(const v1::Speed& speed) {
  switch (speed.amount_case()) {
    case v1::Speed::kPulsesPerS:
      return pulses(speed.pulses_per_s());
    case v1::Speed::kNmPerS:
      return decimal(speed.nm_per_s(), Unit::nanometers);
    case v1::Speed::kUmPerS:
      return decimal(speed.um_per_s(), Unit::micrometers);
    case v1::Speed::kMmPerS:
      return decimal(speed.mm_per_s(), Unit::millimeters);
    case v1::Speed::kDegreesPerS:
      return decimal(speed.degrees_per_s(), Unit::degrees);
    case v1::Speed::kFloating:
      return floating(speed.floating());
    case v1::Speed::AMOUNT_NOT_SET:
      break;
  }
  return fail(Reason::invalid_request, "a speed has no amount",
              "set one of pulses_per_s, nm_per_s, um_per_s, mm_per_s, degrees_per_s and floating");
}

v1::Distance to_distance(const Quantity& quantity) {
  v1::Distance distance;
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

v1::Speed to_speed(const Quantity& quantity) {
  v1::Speed speed;
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

v1::Unit to_proto(Unit unit) {
  static_assert(static_cast<int>(Unit::pulses) + 1 == v1::UNIT_PULSES);
  static_assert(static_cast<int>(Unit::degrees) + 1 == v1::UNIT_DEGREES);
  return static_cast<v1::Unit>(static_cast<int>(unit) + 1);
}

Result<stage::AxisSet> to_axes(const google::protobuf::RepeatedPtrField<std::string>& axes,
                               const api::AxisNames& names) {
  return names.find_all({axes.begin(), axes.end()});
}

Result<int> to_bits(const v1::Pins& pins) {
  constexpr int kPinsMax = 6;
  int bits = 0;
  for (const int pin : pins.on()) {
    if (pin < 1 || pin > kPinsMax) {
      return fail(Reason::out_of_range, fmt::format("there is no pin {}", pin), "pins are numbered from 1 to 6");
    }
    bits |= 1 << (pin - 1);
  }
  return bits;
}

v1::Pins to_pins(int bits) {
  v1::Pins pins;
  for (int pin = 1; bits >> (pin - 1) != 0; ++pin) {
    if ((bits >> (pin - 1) & 1) != 0) pins.add_on(pin);
  }
  return pins;
}

v1::Mode to_mode(std::string_view text) {
  std::string name = "MODE_" + std::string(text);
  std::ranges::replace(name, ',', '_');
  v1::Mode mode = v1::MODE_UNSPECIFIED;
  v1::Mode_Parse(name, &mode);
  return mode;
}

std::string to_text(v1::Mode mode) {
  std::string text = v1::Mode_Name(mode);
  if (text.empty()) return text;
  text.erase(0, std::string_view("MODE_").size());
  std::ranges::replace(text, '_', ',');
  return text;
}

v1::CommandFormat to_format(std::string_view text) {
  v1::CommandFormat format = v1::COMMAND_FORMAT_UNSPECIFIED;
  v1::CommandFormat_Parse("COMMAND_FORMAT_" + std::string(text), &format);
  return format;
}

std::string to_text(v1::CommandFormat format) {
  std::string text = v1::CommandFormat_Name(format);
  return text.empty() ? text : text.substr(std::string_view("COMMAND_FORMAT_").size());
}

Result<int> to_milliseconds(const google::protobuf::Duration& duration) {
  const Duration exact = to_duration(duration);
  if (exact < Duration::zero() || exact > std::chrono::hours(1)) {
    return fail(Reason::out_of_range, "a time is negative or longer than an hour");
  }
  const auto whole = std::chrono::floor<std::chrono::milliseconds>(exact);
  if (whole != exact) {
    return fail(Reason::not_representable, fmt::format("a time of {} ns is not a whole number of ms", exact.count()));
  }
  return static_cast<int>(whole.count());
}

Duration to_span(const google::protobuf::Duration& duration) {
  return std::clamp<Duration>(to_duration(duration), Duration::zero(), server::kSpanMax);
}

Duration to_duration(const google::protobuf::Duration& duration) {
  constexpr std::int64_t kSecondsMax = std::int64_t{200} * 366 * 24 * 3600;
  if (duration.seconds() < 0 || duration.nanos() < 0) return Duration(-1);
  return std::chrono::seconds(std::min(duration.seconds(), kSecondsMax)) + std::chrono::nanoseconds(duration.nanos());
}

google::protobuf::Duration to_proto(Duration duration) {
  google::protobuf::Duration proto;
  const auto seconds = std::chrono::floor<std::chrono::seconds>(duration);
  proto.set_seconds(seconds.count());
  proto.set_nanos(static_cast<std::int32_t>((duration - seconds).count()));
  return proto;
}

}  // namespace axisgate::proto
