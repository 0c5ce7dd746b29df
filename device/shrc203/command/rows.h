// The parameters of the rows of the command table, and the rows themselves, by effect.
#pragma once

#include <array>
#include <span>

#include "device/shot/command/row_forms.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203::rows {

using namespace shot::rows;  // NOLINT(google-build-using-namespace)

std::span<const CommandRow> questions();  // rows that change nothing
std::span<const CommandRow> motion();     // rows that start, prepare or stop a motion
std::span<const CommandRow> arcs();       // rows that prepare a motion along a curve
std::span<const CommandRow> settings();   // settings of the controller and its axes
std::span<const CommandRow> saved_positions();
std::span<const CommandRow> other_modes();  // out of HOST and back: modes, dialect, programs, memory switches

using Kind = Parameter::Kind;

// Letters, as manual 4. defines them for its commands.
inline constexpr Parameter kAxes{"a", "axes: 1, 2, 3, A=1+2, B=1+3, C=2+3, D=1+2+3, W=all controllable", Kind::choice,
                                 "1 2 3 A B C D W"};
inline constexpr Parameter kLineAxes{"a", "axes of the line: A=1+2, B=1+3, C=2+3, D=1+2+3", Kind::choice, "A B C D"};
inline constexpr Parameter kSign{"m", "direction", Kind::choice, "+ -"};
inline constexpr Parameter kUnit{"u", "unit: P pulse, N nm, U um, M mm, D degree", Kind::choice, "P N U M D"};
inline constexpr Parameter kLineUnit{"u", "unit: P pulse, N nm, U um, M mm", Kind::choice, "P N U M"};
inline constexpr Parameter kCounter{"c", "counter: E scale, C command", Kind::choice, "E C"};
inline constexpr Parameter kDistance{"y", "distance", Kind::decimal, {}, 0, 999'999'999, "pulses"};
inline constexpr Parameter kCoordinate{"c", "coordinate", Kind::decimal, {}, 0, 999'999'999, "pulses"};
inline constexpr Parameter kMinimumSpeed{"spds", "minimum speed S", Kind::decimal, {}, 1, 1'000'000, "pulses/s"};
inline constexpr Parameter kMaximumSpeed{"spdf", "maximum speed F", Kind::decimal, {}, 1, 1'000'000, "pulses/s"};
inline constexpr Parameter kSpeedUnit{"u", "unit, each per second: F pulse, N nm, U um, M mm, D degree", Kind::choice,
                                      "F N U M D"};
inline constexpr Parameter kSpeed{"spd", "speed", Kind::decimal, {}, 1, 1'000'000, "pulses/s"};
inline constexpr Parameter kAcceleration{"r", "acceleration and deceleration time R", Kind::integer, {}, 1, 1000, "ms"};
inline constexpr Parameter kMethod{"m", "origin return: 0 MARK, 1 MINI, 2 MIDDLE, 3 ORGS, 4 NORMAL", Kind::choice,
                                   "0 1 2 3 4"};
inline constexpr Parameter kExcitation{"c", "motor: 0 excitation off, 1 on", Kind::choice, "0 1"};

inline constexpr std::array kAxesOnly{kAxes};
inline constexpr std::array kAxesAndUnit{kAxes, kUnit};
inline constexpr std::array kUnitOnly{kUnit};
inline constexpr std::array kUnitAndCounter{kUnit, kCounter};
inline constexpr std::array kOriginReturn{kMethod, kAxes};
inline constexpr std::array kAmounts{kAxes, kSign, kUnit, kDistance};
inline constexpr std::array kAmountsAndSpeeds{kAxes,         kSign,         kUnit,        kDistance,
                                              kMinimumSpeed, kMaximumSpeed, kAcceleration};
inline constexpr std::array kCoordinates{kAxes, kSign, kUnit, kCoordinate};
inline constexpr std::array kLineAmounts{kLineAxes, kSign, kLineUnit, kDistance};
inline constexpr std::array kLineAmountsAndSpeed{kLineAxes,     kSign,         kUnit,        kDistance,
                                                 kMinimumSpeed, kMaximumSpeed, kAcceleration};
inline constexpr std::array kSpeeds{kAxes, kMinimumSpeed, kMaximumSpeed, kAcceleration};
inline constexpr std::array kDirections{kAxes, kSign};
inline constexpr std::array kSpeedsWithUnit{kAxes, kSpeedUnit, kSpeed};
inline constexpr std::array kAxesAndSpeedUnit{kAxes, kSpeedUnit};
inline constexpr std::array kAxesAndTime{kAxes, kAcceleration};
inline constexpr std::array kAxesAndExcitation{kAxes, kExcitation};

}  // namespace axisgate::shrc203::rows
