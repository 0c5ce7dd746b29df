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

// nullopt if the key is absent or, with an error, wrong. `shown` is the axis's unit, and the unit of an amount without
// one; lengths and degrees must not be mixed.
std::optional<Quantity> read_quantity(ConfigTable& table, std::string_view key, Unit shown, ParseQuantity parse);

// Reads the keys travel_minimum, travel_maximum and maximum_speed.
void read_bounds(ConfigTable& table, Unit shown, stage::AxisLimits& limits);

// Reads the name of a unit. nullopt if the key is absent or, with an error, wrong.
std::optional<Unit> read_unit(ConfigTable& table, std::string_view key);

// Reports whether `a` is less than `b`. nullopt if one is absent, or if the comparison needs the size of a pulse.
std::optional<bool> below(const std::optional<Quantity>& a, const std::optional<Quantity>& b);

}  // namespace axisgate::server
