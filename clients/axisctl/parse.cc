#include "clients/axisctl/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

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

// The path's speed belongs to its lower axis (manual 2.4), so a bare number is in that axis's unit.
const v1::Axis& lowest_axis(const v1::Device& device, const std::vector<v1::AxisDistance>& places) {
  const auto lowest =
      std::min_element(places.begin(), places.end(), [](const auto& a, const auto& b) { return a.axis() < b.axis(); });
  return find_axis(device, std::to_string(lowest->axis()));
}

v1::Segment parse_segment(const v1::Device& device, const PathOptions& options, const std::vector<std::string>& words) {
  std::vector<v1::AxisDistance> places;
  std::string speed = options.speed;
  for (const std::string& word : words) {
    constexpr std::string_view prefix = "speed=";
    if (word.rfind(prefix, 0) == 0) {
      speed = word.substr(prefix.size());
    } else {
      places.push_back(parse_place(device, word));
    }
  }
  if (places.empty()) throw usage("no axis is named", "write AXIS=AMOUNT, as 1=+5mm");
  v1::Segment segment;
  if (places.size() == 1) {
    *segment.mutable_single() = places.front();
  } else {
    segment.mutable_line()->mutable_distances()->Add(places.begin(), places.end());
  }
  segment.set_relative(!options.absolute);
  segment.set_acceleration_ms(options.acceleration_ms);
  if (!speed.empty()) *segment.mutable_speed() = parse_speed_for(lowest_axis(device, places), speed);
  return segment;
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream stream(line.substr(0, line.find('#')));
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
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

v1::AxisDistance parse_place(const v1::Device& device, std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) {
    throw usage(fmt::format("\"{}\" is not AXIS=AMOUNT", text), "as 1=+5mm");
  }
  const v1::Axis& axis = find_axis(device, text.substr(0, equals));
  const Result<Quantity> amount = parse_quantity(text.substr(equals + 1), core_unit(axis.unit()));
  if (!amount) throw to_usage(amount.error());
  v1::AxisDistance place;
  place.set_axis(axis.number());
  *place.mutable_distance() = to_distance(*amount);
  return place;
}

v1::AxisJog parse_direction(const v1::Device& device, std::string_view text) {
  const std::size_t equals = text.find('=');
  const std::string_view sign = equals == std::string_view::npos ? "" : text.substr(equals + 1);
  if (sign != "+" && sign != "-") {
    throw usage(fmt::format("\"{}\" is not AXIS=+ or AXIS=-", text), "as 1=+ 2=-; `axisctl move` goes a certain way");
  }
  v1::AxisJog jog;
  jog.set_axis(find_axis(device, text.substr(0, equals)).number());
  jog.set_direction(sign == "+" ? v1::AxisJog::DIRECTION_PLUS : v1::AxisJog::DIRECTION_MINUS);
  return jog;
}

std::optional<std::int64_t> parse_steps(std::string_view text, int decimals, std::int64_t most) {
  const Result<Decimal> value = parse_decimal(text);
  if (!value || value->decimals > decimals || value->digits < 0) return std::nullopt;
  std::int64_t steps = value->digits;
  for (int decimal = value->decimals; decimal < decimals && steps <= most; ++decimal) steps *= 10;
  return steps <= most ? std::optional(steps) : std::nullopt;
}

std::vector<v1::Segment> parse_path(const v1::Device& device, const PathOptions& options, std::istream& input,
                                    const std::string& file_name) {
  std::vector<v1::Segment> segments;
  std::string line;
  for (int number = 1; std::getline(input, line); ++number) {
    try {
      const std::vector<std::string> words = words_of(line);
      if (!words.empty()) segments.push_back(parse_segment(device, options, words));
    } catch (Failure& failure) {
      failure.message = fmt::format("{}:{}: {}", file_name, number, failure.message);
      throw;
    }
  }
  if (input.bad()) throw usage(fmt::format("{}: cannot be read to its end", file_name), "is it a file?");
  if (segments.empty()) throw usage(fmt::format("{}: no segment in it", file_name), "write one a line, as 1=1mm 2=1mm");
  return segments;
}

}  // namespace axisgate::axisctl
