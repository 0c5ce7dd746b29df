#include "clients/axisctl/parse.h"

#include <fmt/format.h>
#include <google/protobuf/util/time_util.h>

#include <cctype>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

std::string names_of(const v1::Device& device) {
  std::vector<std::string> names;
  for (const v1::Axis& axis : device.axes()) {
    names.push_back(axis.name().empty() ? std::to_string(axis.number())
                                        : fmt::format("{} ({})", axis.number(), axis.name()));
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::int64_t whole_pulses(const Quantity& quantity) {
  if (quantity.value.decimals == 0) return quantity.value.digits;
  throw usage(fmt::format("{} is not a whole number of pulses", to_string(quantity.value)),
              "pulses are whole; give a length to have it converted");
}

}  // namespace

const v1::Axis& find_axis(const v1::Device& device, std::string_view number_or_name) {
  for (const v1::Axis& axis : device.axes()) {
    if (std::to_string(axis.number()) == number_or_name) return axis;
  }
  for (const v1::Axis& axis : device.axes()) {
    if (!axis.name().empty() && axis.name() == number_or_name) return axis;
  }
  throw Failure{kUsage, "UNKNOWN_AXIS", fmt::format("{} has no axis \"{}\"", device.name(), number_or_name),
                "its axes are " + names_of(device)};
}

std::vector<int> find_axes(const v1::Device& device, const std::vector<std::string>& numbers_or_names) {
  std::vector<int> axes;
  for (const std::string& text : numbers_or_names) axes.push_back(find_axis(device, text).number());
  return axes;
}

v1::Distance to_distance(const Quantity& quantity) {
  v1::Distance distance;
  switch (quantity.unit) {
    case Unit::pulses:
      distance.set_pulses(whole_pulses(quantity));
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
      speed.set_pulses_per_s(whole_pulses(quantity));
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

v1::Speed parse_speed_for(const v1::Axis& axis, std::string_view text) {
  const Result<Quantity> speed = parse_speed(text, core_unit(axis.unit()));
  if (!speed) throw to_usage(speed.error());
  return to_speed(*speed);
}

v1::Distance parse_amount_for(const v1::Axis& axis, std::string_view text) {
  const Result<Quantity> amount = parse_quantity(text, core_unit(axis.unit()));
  if (!amount) throw to_usage(amount.error());
  return to_distance(*amount);
}

v1::AxisDistance parse_place(const v1::Device& device, std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    throw usage(fmt::format("\"{}\" is not AXIS=AMOUNT", text), "e.g. 1=+5mm");
  }
  const v1::Axis& axis = find_axis(device, text.substr(0, equals));
  v1::AxisDistance place;
  place.set_axis(std::to_string(axis.number()));
  *place.mutable_distance() = parse_amount_for(axis, text.substr(equals + 1));
  return place;
}

v1::AxisJog parse_direction(const v1::Device& device, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view sign = equals == std::string_view::npos ? "" : text.substr(equals + 1);
  if (sign != "+" && sign != "-") {
    throw usage(fmt::format("\"{}\" is not AXIS=+ or AXIS=-", text),
                "e.g. 1=+ 2=-; `axisctl move` moves by a distance");
  }
  v1::AxisJog jog;
  jog.set_axis(std::to_string(find_axis(device, text.substr(0, equals)).number()));
  jog.set_direction(sign == "+" ? v1::AxisJog::DIRECTION_PLUS : v1::AxisJog::DIRECTION_MINUS);
  return jog;
}

v1::Pins to_pins(int bits) {
  v1::Pins pins;
  for (int pin = 1; bits >> (pin - 1) != 0; ++pin) {
    if ((bits >> (pin - 1) & 1) != 0) pins.add_on(pin);
  }
  return pins;
}

google::protobuf::Duration from_milliseconds(std::int64_t count) {
  return google::protobuf::util::TimeUtil::MillisecondsToDuration(count);
}

v1::Mode parse_mode(const std::string& text) {
  std::string name = "MODE_" + text;
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  v1::Mode mode = v1::MODE_UNSPECIFIED;
  if (!v1::Mode_Parse(name, &mode)) throw usage(fmt::format("there is no mode \"{}\"", text), "");
  return mode;
}

v1::CommandFormat parse_format(const std::string& text) {
  std::string name = "COMMAND_FORMAT_" + text;
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  v1::CommandFormat format = v1::COMMAND_FORMAT_UNSPECIFIED;
  if (!v1::CommandFormat_Parse(name, &format)) {
    throw usage(fmt::format("there is no command format \"{}\"", text), "");
  }
  return format;
}

std::optional<std::int64_t> parse_steps(std::string_view text, int decimals, std::int64_t most) {
  const Result<Decimal> value = parse_decimal(text);
  if (!value || value->decimals > decimals || value->digits < 0) return std::nullopt;
  std::int64_t steps = value->digits;
  for (int decimal = value->decimals; decimal < decimals && steps <= most; ++decimal) steps *= 10;
  return steps <= most ? std::optional(steps) : std::nullopt;
}

}  // namespace axisgate::axisctl
