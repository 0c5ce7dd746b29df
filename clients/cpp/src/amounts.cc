#include "clients/cpp/src/amounts.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <iterator>
#include <string_view>

#include "axisgate/errors.h"

namespace axisgate::client {
namespace {

struct UnitRow {
  std::string_view text;
  v1::Unit number;
  void (v1::Distance::*set_distance)(const std::string&);
  void (v1::Speed::*set_speed)(const std::string&);
};

// A whole number of pulses has another type in the API.
constexpr std::string_view kPulses = "pulses";

const UnitRow kUnits[] = {
    {kPulses, v1::UNIT_PULSES, nullptr, nullptr},
    {"nm", v1::UNIT_NANOMETERS, &v1::Distance::set_nm<const std::string&>,
     &v1::Speed::set_nm_per_s<const std::string&>},
    {"um", v1::UNIT_MICROMETERS, &v1::Distance::set_um<const std::string&>,
     &v1::Speed::set_um_per_s<const std::string&>},
    {"mm", v1::UNIT_MILLIMETERS, &v1::Distance::set_mm<const std::string&>,
     &v1::Speed::set_mm_per_s<const std::string&>},
    {"deg", v1::UNIT_DEGREES, &v1::Distance::set_degrees<const std::string&>,
     &v1::Speed::set_degrees_per_s<const std::string&>},
};

const UnitRow& row_of(std::string_view unit) { return *std::ranges::find(kUnits, unit, &UnitRow::text); }

std::int64_t whole_pulses(const std::string& text) {
  std::int64_t count = 0;
  const char* const first = text.data() + (text.starts_with('+') ? 1 : 0);
  const char* const last = text.data() + text.size();
  const auto [end, error] = std::from_chars(first, last, count);
  if (error != std::errc() || end != last) throw InvalidArgument(text + " is not a whole number of pulses");
  return count;
}

v1::FloatingAmount floating(double value, const UnitRow& unit) {
  v1::FloatingAmount amount;
  amount.set_value(value);
  amount.set_unit(unit.number);
  amount.set_rounding(v1::ROUNDING_NEAREST);
  return amount;
}

}  // namespace

v1::Distance to_message(const Distance& distance) {
  const UnitRow& unit = row_of(distance.unit());
  v1::Distance message;
  if (const double* value = std::get_if<double>(&distance.number())) {
    *message.mutable_floating() = floating(*value, unit);
  } else if (unit.text == kPulses) {
    message.set_pulses(whole_pulses(std::get<std::string>(distance.number())));
  } else {
    (message.*unit.set_distance)(std::get<std::string>(distance.number()));
  }
  return message;
}

v1::Speed to_message(const Speed& speed) {
  const Distance& each_second = speed.each_second();
  const UnitRow& unit = row_of(each_second.unit());
  v1::Speed message;
  if (const double* value = std::get_if<double>(&each_second.number())) {
    *message.mutable_floating() = floating(*value, unit);
  } else if (unit.text == kPulses) {
    message.set_pulses_per_s(whole_pulses(std::get<std::string>(each_second.number())));
  } else {
    (message.*unit.set_speed)(std::get<std::string>(each_second.number()));
  }
  return message;
}

std::string unit_text(v1::Unit unit) {
  const auto found = std::ranges::find(kUnits, unit, &UnitRow::number);
  return found == std::end(kUnits) ? fmt::format("UNIT {}", static_cast<int>(unit)) : std::string(found->text);
}

}  // namespace axisgate::client
