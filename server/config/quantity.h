// Amounts with their units in the configuration.
#pragma once

#include <optional>
#include <string_view>

#include "device/config/config_table.h"
#include "device/core/quantity.h"
#include "device/stage/profile.h"
#include "server/config/config.h"

namespace axisgate::server {

using ParseQuantity = Result<Quantity> (*)(std::string_view, Unit);

// Nothing where the key is absent or wrong, which is an error then. `shown` is the axis's unit, and that of an amount
// without one; lengths and degrees do not go together.
std::optional<Quantity> read_quantity(ConfigTable& table, std::string_view key, Unit shown, ParseQuantity parse);

// The keys travel_minimum, travel_maximum and maximum_speed.
void read_bounds(ConfigTable& table, Unit shown, stage::AxisLimits& limits);

// A unit's name; an error where it is none.
std::optional<Unit> read_unit(ConfigTable& table, std::string_view key);

// Nothing where one is missing, or where only what a pulse is can tell.
std::optional<bool> below(const std::optional<Quantity>& a, const std::optional<Quantity>& b);

}  // namespace axisgate::server
