// Forms from which the rows of a model's table are made.
#pragma once

#include <array>
#include <span>

#include "device/shot/command/command_row.h"
#include "device/shot/limits.h"

namespace axisgate::shot::rows {

inline constexpr std::array kNone = std::array<Parameter, 0>{};

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

}  // namespace axisgate::shot::rows
