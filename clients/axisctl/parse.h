// What people type as amounts and axes. Decimals stay text from the keyboard to the daemon: they are exact there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "axisgate/v1/device.pb.h"
#include "axisgate/v1/stage.pb.h"
#include "device/core/quantity.h"

namespace axisgate::axisctl {

// Everything here throws Failure for what it cannot read.

// By number, or by configured name.
const v1::Axis& find_axis(const v1::Device& device, std::string_view number_or_name);

// Numbers, in the order given.
std::vector<int> find_axes(const v1::Device& device, const std::vector<std::string>& numbers_or_names);

v1::Distance to_distance(const Quantity& quantity);
v1::Speed to_speed(const Quantity& quantity);

// "+5mm"; a bare number is in the axis's unit.
v1::Distance parse_amount_for(const v1::Axis& axis, std::string_view text);

// "2mm/s"; a bare number is in the axis's unit.
v1::Speed parse_speed_for(const v1::Axis& axis, std::string_view text);

// "1=+5mm"; a bare number is in the axis's unit.
v1::AxisDistance parse_place(const v1::Device& device, std::string_view text);

// "1=+", "1=-": a way to run, without a speed.
v1::AxisJog parse_direction(const v1::Device& device, std::string_view text);

// "0.2" with one decimal: 2 steps of 0.1. Nothing where it is no whole number of them, or not from 0 to `most`.
std::optional<std::int64_t> parse_steps(std::string_view text, int decimals, std::int64_t most);

}  // namespace axisgate::axisctl
