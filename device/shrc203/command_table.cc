#include "device/shrc203/command_table.h"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace axisgate::shrc203 {
namespace {

using Kind = Parameter::Kind;

// The letters, as manual 4. defines them again and again for its commands.
constexpr Parameter kAxes{"a", "axes: 1, 2, 3, A=1+2, B=1+3, C=2+3, D=1+2+3, W=all controllable", Kind::choice,
                          "1 2 3 A B C D W"};
constexpr Parameter kLineAxes{"a", "axes of the line: A=1+2, B=1+3, C=2+3, D=1+2+3", Kind::choice, "A B C D"};
constexpr Parameter kSign{"m", "direction", Kind::choice, "+ -"};
constexpr Parameter kUnit{"u", "unit: P pulse, N nm, U um, M mm, D degree", Kind::choice, "P N U M D"};
constexpr Parameter kLineUnit{"u", "unit: P pulse, N nm, U um, M mm", Kind::choice, "P N U M"};
constexpr Parameter kCounter{"c", "counter: E scale, C command", Kind::choice, "E C"};
constexpr Parameter kDistance{"y", "distance", Kind::decimal, {}, 0, 999'999'999, "pulses"};
constexpr Parameter kCoordinate{"c", "coordinate", Kind::decimal, {}, 0, 999'999'999, "pulses"};
constexpr Parameter kMinimumSpeed{"spds", "minimum speed S", Kind::decimal, {}, 1, 1'000'000, "pulses/s"};
constexpr Parameter kMaximumSpeed{"spdf", "maximum speed F", Kind::decimal, {}, 1, 1'000'000, "pulses/s"};
constexpr Parameter kSpeedUnit{"u", "unit, each per second: F pulse, N nm, U um, M mm, D degree", Kind::choice,
                               "F N U M D"};
constexpr Parameter kSpeed{"spd", "speed", Kind::decimal, {}, 1, 1'000'000, "pulses/s"};
constexpr Parameter kAcceleration{"r", "acceleration and deceleration time R", Kind::integer, {}, 1, 1000, "ms"};
constexpr Parameter kMethod{"m", "origin return: 0 MARK, 1 MINI, 2 MIDDLE, 3 ORGS, 4 NORMAL", Kind::choice,
                            "0 1 2 3 4"};
constexpr Parameter kExcitation{"c", "motor: 0 excitation off, 1 on", Kind::choice, "0 1"};

constexpr std::array kNone = std::array<Parameter, 0>{};
constexpr std::array kAxesOnly{kAxes};
constexpr std::array kAxesAndUnit{kAxes, kUnit};
constexpr std::array kUnitOnly{kUnit};
constexpr std::array kUnitAndCounter{kUnit, kCounter};
constexpr std::array kOriginReturn{kMethod, kAxes};
constexpr std::array kAmounts{kAxes, kSign, kUnit, kDistance};
constexpr std::array kAmountsAndSpeeds{kAxes, kSign, kUnit, kDistance, kMinimumSpeed, kMaximumSpeed, kAcceleration};
constexpr std::array kCoordinates{kAxes, kSign, kUnit, kCoordinate};
constexpr std::array kLineAmounts{kLineAxes, kSign, kLineUnit, kDistance};
constexpr std::array kLineAmountsAndSpeed{kLineAxes,     kSign,         kUnit,        kDistance,
                                          kMinimumSpeed, kMaximumSpeed, kAcceleration};
constexpr std::array kSpeeds{kAxes, kMinimumSpeed, kMaximumSpeed, kAcceleration};
constexpr std::array kDirections{kAxes, kSign};
constexpr std::array kSpeedsWithUnit{kAxes, kSpeedUnit, kSpeed};
constexpr std::array kAxesAndExcitation{kAxes, kExcitation};

constexpr CommandRow question(std::string_view name, std::string_view format, std::string_view description, int section,
                              std::span<const Parameter> parameters, std::string_view reply) {
  return {.name = name,
          .format = format,
          .description = description,
          .section = section,
          .parameters = parameters,
          .reply = reply};
}

// A question per axis whose single answer could be a completion: asked for all axes at once.
constexpr CommandRow axis_question(std::string_view name, std::string_view format, std::string_view description,
                                   int section, std::span<const Parameter> parameters, std::string_view reply) {
  CommandRow row = question(name, format, description, section, parameters, reply);
  row.scope = CommandScope::axes;
  row.separation = Separation::all_axes;
  return row;
}

// A question with one number as its answer, for which no way exists to ask with commas.
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

// A prebuffer setter may also answer OK_D, is accepted while the stage moves, and lets completions follow the G.
constexpr CommandRow prebuffer(CommandRow row) {
  row.reply = "OK|OK_D";
  row.completes = true;
  return row;
}

constexpr CommandRow shifts_frame(CommandRow row) {
  row.shifts_frame = true;
  return row;
}

constexpr CommandRow completes(CommandRow row) {
  row.completes = true;
  return row;
}

constexpr CommandRow whole_controller(CommandRow row) {
  row.scope = CommandScope::controller;
  return row;
}

constexpr Needs kNothing{};
constexpr Needs kReady{.ready = true};
constexpr Needs kExcited{.excited = true};
constexpr Needs kReadyExcited{.ready = true, .excited = true};
constexpr Needs kReadyExcitedNoLimit{.ready = true, .excited = true, .no_limit = true};
constexpr Needs kExcitedNoLimit{.excited = true, .no_limit = true};

constexpr CommandRow kRows[] = {
    any_mode(question("*IDN?", "*IDN?", "vendor, model, serial number, firmware", 1, kNone, "identity")),
    question("!:", "!:", "whether any axis is busy", 2, kNone, "ready"),
    question("!:S", "!:[<a>]S", "whether each axis is busy", 3, kAxesOnly, "ready*"),
    question("Q:", "Q:", "coordinates and status", 4, kNone, "coordinate,coordinate,coordinate,error,stop,ready"),
    question("Q:S", "Q:S[<u>][<c>]", "coordinates and status of each axis", 5, kUnitAndCounter, "amount*,hex*,ready*"),
    question("SRQ:", "SRQ:", "status", 6, kNone, "error,stop,ready"),
    question("SRQ:S", "SRQ:[<a>]S", "status of each axis", 7, kAxesOnly, "hex*,ready*"),
    question("?:V", "?:V", "firmware version", 8, kNone, "version"),
    axis_question("?:P", "?:P[<a>]", "way of one pulse in nm", 10, kAxesOnly, "decimal*"),
    question("?:D", "?:D[<a>]", "speeds S, F and time R", 13, kAxesOnly, "speed*"),
    axis_question("?:M", "?:M[<a>][,<u>]", "relative movement set, execution buffer", 18, kAxesAndUnit, "setting*"),
    axis_question("?:MP", "?:MP[<a>][,<u>]", "relative movement set, prebuffer", 19, kAxesAndUnit, "setting*"),
    axis_question("?:A", "?:A[<a>][,<u>]", "absolute target set, execution buffer", 20, kAxesAndUnit, "setting*"),
    axis_question("?:AP", "?:AP[<a>][,<u>]", "absolute target set, prebuffer", 21, kAxesAndUnit, "setting*"),
    question("?:E", "?:E[,<u>]", "arc set, execution buffer", 22, kUnitOnly, "arc"),
    question("?:EP", "?:EP[,<u>]", "arc set, prebuffer", 23, kUnitOnly, "arc"),
    question("?:K", "?:K[,<u>]", "straight line set, execution buffer", 24, kUnitOnly, "line"),
    question("?:KP", "?:KP[,<u>]", "straight line set, prebuffer", 25, kUnitOnly, "line"),
    closed(number_question("?:O", "general-purpose outputs", 26, "number:0:63")),
    number_question("?:W", "wait before READY, in 0.1 s", 27, "number:0:2550"),
    axis_question("?:WT", "?:WT[<a>]", "wait set, prebuffer, in 0.1 s", 28, kAxesOnly, "number_or_NS:0:2550*"),
    axis_question("?:WI", "?:WI[<a>]", "input pattern waited for, prebuffer", 29, kAxesOnly, "number_or_NS:0:63*"),
    question("?:N", "?:N", "model name", 30, kNone, "model"),
    question("?:J", "?:J[<a>]", "jog direction set", 31, kAxesOnly, "direction*"),
    axis_question("?:ACS", "?:ACS[<a>]", "auto-config status", 32, kAxesOnly, "config*"),
    axis_question("?:C", "?:C[<a>]", "motor excitation", 33, kAxesOnly, "number:0:1*"),
    axis_question("?:F", "?:F[<a>]", "stage control: 0 closed loop, 1 open loop", 34, kAxesOnly, "number:0:1*"),
    number_question("?:SLEEP", "sleep", 35, "number:0:1"),
    number_question("?:BO", "display lighting", 36, "number:0:1"),
    any_mode(question("?:MODE", "?:MODE", "operation mode", 37, kNone, "mode")),
    question("?:FMT", "?:FMT", "command format", 38, kNone, "format"),
    number_question("?:BEEP", "beep", 39, "number:0:1"),
    any_mode(question("?:CMD", "?:CMD", "the command received before this one", 40, kNone, "echo")),
    question("?:SN", "?:SN", "serial number", 43, kNone, "serial"),
    number_question("?:AXIS", "controllable axes", 44, "number:0:6"),
    shifts_frame(command("PSET:", "PSET:<a>{<m><u><c>}", "make this the coordinate of where the axis stands", 45,
                         kCoordinates, Effect::setting, kReady)),
    command("C:", "C:<a><c>", "switch motor excitation", 52, kAxesAndExcitation, Effect::setting, kReady),
    command("BEC:", "BEC:[<a>]", "clear BUSY, limit, overflow and emergency errors", 53, kAxesOnly, Effect::setting,
            kNothing),
    command("H:", "H[<m>]:[<a>]", "mechanical origin return", 59, kOriginReturn, Effect::motion, kReadyExcited),
    completes(command("HRT:", "HRT[<m>]:[<a>]", "mechanical origin return with completions", 60, kOriginReturn,
                      Effect::motion, kReadyExcited)),
    command("Z:", "Z:[<a>]", "return to the logical origin", 61, kAxesOnly, Effect::motion, kReadyExcited),
    completes(command("ZRT:", "ZRT:[<a>]", "return to the logical origin with completions", 62, kAxesOnly,
                      Effect::motion, kReadyExcited)),
    shifts_frame(command("R:", "R:[<a>]", "set the logical origin: the coordinate becomes 0", 63, kAxesOnly,
                         Effect::setting, kReadyExcited)),
    shifts_frame(
        command("RC:", "RC:[<a>]", "take the logical origin back", 64, kAxesOnly, Effect::setting, kReadyExcited)),
    command("L:", "L:[<a>]", "decelerate and stop", 65, kAxesOnly, Effect::stop, kExcited),
    whole_controller(command("L:E", "L:E", "emergency stop of all axes", 66, kNone, Effect::stop, kNothing)),
    setter("M:", "M:<a>{<m><u><y>}", "set a relative movement", 67, kAmounts, Register::m, kReadyExcited),
    prebuffer(setter("MP:", "MP:<a>{<m><u><y>}[,{S<spds>F<spdf>R<r>| }]", "set a relative movement, prebuffer", 68,
                     kAmountsAndSpeeds, Register::mp, kExcited)),
    setter("A:", "A:<a>{<m><u><y>}", "set an absolute target", 69, kAmounts, Register::a, kReadyExcited),
    prebuffer(setter("AP:", "AP:<a>{<m><u><y>}[,{S<spds>F<spdf>R<r>| }]", "set an absolute target, prebuffer", 70,
                     kAmountsAndSpeeds, Register::ap, kExcited)),
    whole_controller(
        setter("K:", "K:<a>{<m><u><y>}", "set a straight line", 83, kLineAmounts, Register::k, kReadyExcitedNoLimit)),
    whole_controller(prebuffer(setter("KP:", "KP:<a>{<m><u><y>}[,S<spds>F<spdf>R<r>]", "set a straight line, prebuffer",
                                      84, kLineAmountsAndSpeed, Register::kp, kExcitedNoLimit))),
    completes(whole_controller(
        command("G", "G", "start what was set, all controllable axes", 85, kNone, Effect::motion, kReadyExcited))),
    completes(command("G:", "G:[<a>]", "start what was set", 86, kAxesOnly, Effect::motion, kReadyExcited)),
    command("GC:", "GC:[<a>]", "delete what M, A, E and K have set", 87, kAxesOnly, Effect::setting, kReadyExcited),
    setter("J:", "J:<a>{<m>}", "set a jog: at speed S until it is stopped", 88, kDirections, Register::j,
           kReadyExcited),
    command("D:", "D:<a>{S<spds>F<spdf>R<r>| }", "set speeds S, F and time R", 89, kSpeeds, Effect::setting, kReady),
    command("JD:", "JD:<a>{<u><spd>}", "change the speed of a running jog", 93, kSpeedsWithUnit, Effect::setting,
            kExcited),
    closed(number_question("I:", "general-purpose inputs", 95, "number:0:63")),
};

}  // namespace

std::span<const CommandRow> command_table() { return kRows; }

const CommandRow& command_row(std::string_view name) {
  const auto row = std::ranges::find(kRows, name, &CommandRow::name);
  if (row == std::end(kRows)) std::abort();
  return *row;
}

}  // namespace axisgate::shrc203
