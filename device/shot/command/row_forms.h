// The parameters and forms from which the rows of the command table are made, and the rows themselves, by effect.
#pragma once

#include <array>
#include <span>

#include "device/shot/command/command_row.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203::rows {

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

inline constexpr std::array kNone = std::array<Parameter, 0>{};
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

constexpr CommandRow question(std::string_view name, std::string_view format, std::string_view description, int section,
                              std::span<const Parameter> parameters, std::string_view reply) {
  return {.name = name,
          .format = format,
          .description = description,
          .section = section,
          .parameters = parameters,
          .reply = reply,
          .meaning = name.starts_with("?:") || name == "*IDN?" ? Meaning::inquiry : Meaning::none};
}

// A question for each axis whose single answer could be a completion: it is sent for all axes at once.
constexpr CommandRow axis_question(std::string_view name, std::string_view format, std::string_view description,
                                   int section, std::span<const Parameter> parameters, std::string_view reply) {
  CommandRow row = question(name, format, description, section, parameters, reply);
  row.scope = CommandScope::axes;
  row.separation = Separation::all_axes;
  return row;
}

// A question whose answer is one number, and which cannot be asked so that the answer has commas.
constexpr CommandRow number_question(std::string_view name, std::string_view description, int section,
                                     std::string_view reply) {
  CommandRow row = question(name, name, description, section, kNone, reply);
  row.separation = Separation::waits;
  return row;
}

constexpr CommandRow closed(CommandRow row) {
  row.separation = Separation::closed;
  return row;
}

constexpr CommandRow any_mode(CommandRow row) {
  row.needs.any_mode = true;
  return row;
}

constexpr CommandRow command(std::string_view name, std::string_view format, std::string_view description, int section,
                             std::span<const Parameter> parameters, Effect effect, Needs needs) {
  return {.name = name,
          .format = format,
          .description = description,
          .section = section,
          .parameters = parameters,
          .reply = "OK",
          .effect = effect,
          .lane = effect == Effect::stop ? Lane::stop : Lane::motion,
          .scope = CommandScope::axes,
          .needs = needs};
}

constexpr CommandRow setter(std::string_view name, std::string_view format, std::string_view description, int section,
                            std::span<const Parameter> parameters, Register reg, Needs needs) {
  CommandRow row = command(name, format, description, section, parameters, Effect::motion_setting, needs);
  row.reg = reg;
  return row;
}

constexpr CommandRow sets_speeds(SetsSpeeds which, CommandRow row) {
  row.sets_speeds = which;
  return row;
}

// A prebuffer setter may also answer OK_D, is accepted while the stage moves, and lets completions follow the G.
constexpr CommandRow prebuffer(CommandRow row) {
  row.reply = "OK|OK_D";
  row.completes = true;
  row.sets_speeds = SetsSpeeds::of_motion;
  return row;
}

constexpr CommandRow shifts_frame(CommandRow row) {
  row.shifts_frame = true;
  return row;
}

constexpr CommandRow beside_motion(CommandRow row) {
  row.beside_motion = true;
  return row;
}

constexpr CommandRow completes(CommandRow row) {
  row.completes = true;
  return row;
}

constexpr CommandRow means(Meaning meaning, CommandRow row) {
  row.meaning = meaning;
  return row;
}

constexpr CommandRow whole_controller(CommandRow row) {
  row.scope = CommandScope::controller;
  return row;
}

constexpr CommandRow in_mode(Mode mode, CommandRow row) {
  row.needs.mode = mode;
  return row;
}

constexpr CommandRow enters(Mode mode, CommandRow row) {
  row.enters = mode;
  return row;
}

constexpr CommandRow saves(CommandRow row) {
  row.reply_limit = kSavingReplyLimit;
  return row;
}

inline constexpr Needs kNothing{};
inline constexpr Needs kReady{.ready = true};
inline constexpr Needs kExcited{.excited = true};
inline constexpr Needs kReadyExcited{.ready = true, .excited = true};
inline constexpr Needs kReadyExcitedNoLimit{.ready = true, .excited = true, .no_limit = true};
inline constexpr Needs kExcitedNoLimit{.excited = true, .no_limit = true};

}  // namespace axisgate::shrc203::rows
