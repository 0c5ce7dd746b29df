// Parsing of typed amounts and axes. Decimals stay text until they reach the daemon, so that they stay exact.
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

// All functions but parse_steps() throw Failure if the text is not valid.

// Returns the axis with this number or configured name.
const v1::Axis& find_axis(const v1::Device& device, std::string_view number_or_name);

// Returns the numbers of the axes, in the given order.
std::vector<int> find_axes(const v1::Device& device, const std::vector<std::string>& numbers_or_names);

v1::Distance to_distance(const Quantity& quantity);
v1::Speed to_speed(const Quantity& quantity);

// Parses "+5mm"; a bare number is in the axis's unit.
v1::Distance parse_amount_for(const v1::Axis& axis, std::string_view text);

// Parses "2mm/s"; a bare number is in the axis's unit.
v1::Speed parse_speed_for(const v1::Axis& axis, std::string_view text);

// Parses "1=+5mm"; a bare number is in the axis's unit.
v1::AxisDistance parse_place(const v1::Device& device, std::string_view text);

// Parses a direction, "1=+" or "1=-". The result has no speed.
v1::AxisJog parse_direction(const v1::Device& device, std::string_view text);

// Return the inputs or outputs whose bits are set (pin 1 is 1, pin 2 is 2, pin 3 is 4), and a time.
v1::Pins to_pins(int bits);
google::protobuf::Duration from_milliseconds(std::int64_t count);

// Parse a mode and a command format as the controller writes them: "HOST", "SHOT_FC".
v1::Mode parse_mode(const std::string& text);
v1::CommandFormat parse_format(const std::string& text);

// Parses a decimal number as a count of steps: "0.2" with one decimal is 2 steps of 0.1. nullopt if the text is not a
// whole number of steps from 0 to `most`.
std::optional<std::int64_t> parse_steps(std::string_view text, int decimals, std::int64_t most);

}  // namespace axisgate::axisctl
