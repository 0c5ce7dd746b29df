// Rows of the command table that change a setting without motion: manual 45), 46), 48), 51) to 56), 63), 64), 89) to
// 94), 96) to 101).
#include "device/shrc203/command/rows.h"

namespace axisgate::shrc203::rows {
namespace {

constexpr Parameter kOutputs{"s", "outputs OUT1 to OUT6 as a number: 1, 2, 4, 8, 16, 32", Kind::integer, {}, 0, 63};
constexpr Parameter kTimer{"a", "interval", Kind::integer, {}, 1, 10'000, "0.01 s"};
constexpr Parameter kOneAxis{"a", "axis", Kind::choice, "1 2 3"};
constexpr Parameter kInterval{"b", "interval", Kind::integer, {}, 2, 30'000, "pulses"};
constexpr Parameter kControl{"f", "0 closed loop, 1 open loop", Kind::choice, "0 1"};
constexpr Parameter kLights{"l", "0 off, 1 on", Kind::choice, "0 1"};
constexpr Parameter kBeep{"b", "0 off, 1 on", Kind::choice, "0 1"};
constexpr Parameter kDivisions{"m", "divisions", Kind::choice,
                               "1 2 3 4 5 6 8 10 12 20 25 30 40 50 60 80 100 120 125 200 250 300 400 600 800 1000 2000 "
                               "4000 8000"};
constexpr Parameter kSettling{"w", "wait", Kind::integer, {}, 0, 2550, "0.1 s"};
constexpr std::array kAxesAndControl{kAxes, kControl};
constexpr std::array kLightsOnly{kLights};
constexpr std::array kBeepOnly{kBeep};
constexpr std::array kAxesAndDivisions{kAxes, kDivisions};
constexpr std::array kSettlingOnly{kSettling};
constexpr std::array kOutputsOnly{kOutputs};
constexpr std::array kTriggerTimer{kTimer};
constexpr std::array kTriggerPulses{kOneAxis, kInterval};
constexpr std::array kTriggerScale{kOneAxis, kSign, kInterval};

// The whole controller has one trigger, and it counts while any axis moves.
constexpr CommandRow of_trigger(std::string_view name, std::string_view format, std::string_view description,
                                int section, std::span<const Parameter> parameters) {
  return whole_controller(command(name, format, description, section, parameters, Effect::setting, kReady));
}

constexpr CommandRow of_motion(CommandRow row) { return sets_speeds(SetsSpeeds::of_motion, row); }

constexpr CommandRow restarts(CommandRow row) {
  row.restarts = true;
  return row;
}

constexpr CommandRow rescales(CommandRow row) {
  row.rescales = true;
  return row;
}

constexpr CommandRow kSettingsRows[] = {
    shifts_frame(command("PSET:", "PSET:<a>{<m><u><c>}", "set the coordinate of the present position", 45, kCoordinates,
                         Effect::setting, kReady)),
    restarts(
        whole_controller(command("RESET:", "RESET:", "restart the controller", 46, kNone, Effect::setting, kNothing))),
    whole_controller(
        command("BO:", "BO:<l>", "switch the lights of the display", 48, kLightsOnly, Effect::setting, kReady)),
    command("F:", "F:<a><f>", "closed or open loop", 51, kAxesAndControl, Effect::setting, kReady),
    command("C:", "C:<a><c>", "switch motor excitation", 52, kAxesAndExcitation, Effect::setting, kReady),
    beside_motion(command("BEC:", "BEC:[<a>]", "clear BUSY, limit, overflow and emergency errors", 53, kAxesOnly,
                          Effect::setting, kNothing)),
    whole_controller(command("BEEP:", "BEEP:<b>", "switch the beep", 54, kBeepOnly, Effect::setting, kReady)),
    rescales(shifts_frame(command("S:", "S:<a>,{<m>|,}", "set the divisions of the motor driver", 55, kAxesAndDivisions,
                                  Effect::setting, kReady))),
    whole_controller(command("W:", "W:<w>", "wait between the end of a motion and READY", 56, kSettlingOnly,
                             Effect::setting, kReady)),
    shifts_frame(command("R:", "R:[<a>]", "set the logical origin: the coordinate becomes 0", 63, kAxesOnly,
                         Effect::setting, kReadyExcited)),
    shifts_frame(
        command("RC:", "RC:[<a>]", "take the logical origin back", 64, kAxesOnly, Effect::setting, kReadyExcited)),
    of_motion(command("D:", "D:<a>{S<spds>F<spdf>R<r>| }", "set speeds S, F and time R", 89, kSpeeds, Effect::setting,
                      kReady)),
    means(Meaning::minimum_speed, of_motion(command("DS:", "DS:<a>{<u><spd>}", "set the minimum speed S", 90,
                                                    kSpeedsWithUnit, Effect::setting, kReady))),
    means(Meaning::maximum_speed, of_motion(command("DF:", "DF:<a>{<u><spd>}", "set the maximum speed F", 91,
                                                    kSpeedsWithUnit, Effect::setting, kReady))),
    // Only a blank separates the axis and the first time (manual 92)).
    of_motion(command("DR:", "DR:<a> {<r>|,}", "set the acceleration and deceleration time R", 92, kAxesAndTime,
                      Effect::setting, kReady)),
    means(Meaning::jog, command("JD:", "JD:<a>{<u><spd>}", "change the speed of a running jog", 93, kSpeedsWithUnit,
                                Effect::setting, kNothing)),
    sets_speeds(SetsSpeeds::of_origin_return, command("B:", "B:<a>{S<spds>F<spdf>R<r>| }",
                                                      "set speeds S, F and time R of the mechanical origin return", 94,
                                                      kSpeeds, Effect::setting, kReady)),
    means(Meaning::outputs, beside_motion(whole_controller(command("O:", "O:<s>", "set the general-purpose outputs", 96,
                                                                   kOutputsOnly, Effect::setting, kNothing)))),
    of_trigger("T:T", "T:T<a>", "trigger output: every so often", 97, kTriggerTimer),
    of_trigger("T:P", "T:P<a>P<b>", "trigger output: every so many drive pulses of an axis", 98, kTriggerPulses),
    of_trigger("T:S", "T:S", "trigger output: none", 99, kNone),
    of_trigger("T:M", "T:M", "trigger output: one now", 100, kNone),
    of_trigger("T:E", "T:E<a>P<m><b>", "trigger output: every so many scale pulses of an axis in one direction", 101,
               kTriggerScale),
};

}  // namespace

std::span<const CommandRow> settings() { return kSettingsRows; }

}  // namespace axisgate::shrc203::rows
