#include "server/config/quantity.h"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "device/core/explain.h"

namespace axisgate::server {
namespace {

// A long double has room for the 18 digits of a Decimal.
long double in_smallest_unit(const Quantity& quantity) {
  const int power = quantity.unit == Unit::millimeters ? 6 : quantity.unit == Unit::micrometers ? 3 : 0;
  return static_cast<long double>(quantity.value.digits) * std::pow(10.0L, power - quantity.value.decimals);
}

bool is_length(Unit unit) { return unit != Unit::pulses && unit != Unit::degrees; }

}  // namespace

std::optional<Quantity> read_quantity(ConfigTable& table, std::string_view key, Unit shown, ParseQuantity parse) {
  const std::optional<std::string> text = table.text(key);
  if (!text) return std::nullopt;
  const Result<Quantity> parsed = parse(*text, shown);
  if (!parsed) {
    table.error(key, explain(parsed.error()));
    return std::nullopt;
  }
  // Pulses are allowed for both kinds of axis.
  const bool either = parsed->unit == Unit::pulses || shown == Unit::pulses;
  if (!either && is_length(parsed->unit) != is_length(shown)) {
    table.error(key, fmt::format("is in {}, but the axis is shown in {}; an axis turns or slides, not both",
                                 symbol(parsed->unit), symbol(shown)));
  }
  return *parsed;
}

void read_bounds(ConfigTable& table, Unit shown, stage::AxisLimits& limits) {
  limits.travel_minimum = read_quantity(table, "travel_minimum", shown, parse_quantity);
  limits.travel_maximum = read_quantity(table, "travel_maximum", shown, parse_quantity);
  limits.maximum_speed = read_quantity(table, "maximum_speed", shown, parse_speed);
  if (limits.maximum_speed && limits.maximum_speed->value.digits <= 0) {
    table.error("maximum_speed", "must be above 0");
  }
  if (below(limits.travel_minimum, limits.travel_maximum) == false) {
    table.error("travel_minimum", "must be below travel_maximum");
  }
}

std::optional<Unit> read_unit(ConfigTable& table, std::string_view key) {
  const std::optional<std::string> text = table.text(key);
  if (!text) return std::nullopt;
  if (const Result<Unit> unit = parse_unit(*text)) return *unit;
  table.error(key, fmt::format("\"{}\" is not a unit; use pulse, nm, um, mm or deg", *text));
  return std::nullopt;
}

std::optional<bool> below(const std::optional<Quantity>& a, const std::optional<Quantity>& b) {
  if (!a || !b || (a->unit != b->unit && !(is_length(a->unit) && is_length(b->unit)))) return std::nullopt;
  return in_smallest_unit(*a) < in_smallest_unit(*b);
}

}  // namespace axisgate::server
