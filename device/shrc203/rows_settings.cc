// Rows of the command table that set something, and nothing moves: manual 45), 52), 53), 63), 64), 89), 93),
// 96) to 101).
#include "device/shrc203/rows.h"

namespace axisgate::shrc203::rows {
namespace {

constexpr Parameter kOutputs{"s", "outputs OUT1 to OUT6 as a number: 1, 2, 4, 8, 16, 32", Kind::integer, {}, 0, 63};
constexpr Parameter kTimer{"a", "interval", Kind::integer, {}, 1, 10'000, "0.01 s"};
constexpr Parameter kOneAxis{"a", "axis", Kind::choice, "1 2 3"};
constexpr Parameter kInterval{"b", "interval", Kind::integer, {}, 2, 30'000, "pulses"};
constexpr std::array kOutputsOnly{kOutputs};
constexpr std::array kTriggerTimer{kTimer};
constexpr std::array kTriggerPulses{kOneAxis, kInterval};
constexpr std::array kTriggerScale{kOneAxis, kSign, kInterval};

// One for the whole controller, and it counts while anything moves.
constexpr CommandRow of_trigger(std::string_view name, std::string_view format, std::string_view description,
                                int section, std::span<const Parameter> parameters) {
  return whole_controller(command(name, format, description, section, parameters, Effect::setting, kReady));
}

constexpr CommandRow kRows[] = {
    shifts_frame(command("PSET:", "PSET:<a>{<m><u><c>}", "make this the coordinate of where the axis stands", 45,
                         kCoordinates, Effect::setting, kReady)),
    command("C:", "C:<a><c>", "switch motor excitation", 52, kAxesAndExcitation, Effect::setting, kReady),
    beside_motion(command("BEC:", "BEC:[<a>]", "clear BUSY, limit, overflow and emergency errors", 53, kAxesOnly,
                          Effect::setting, kNothing)),
    shifts_frame(command("R:", "R:[<a>]", "set the logical origin: the coordinate becomes 0", 63, kAxesOnly,
                         Effect::setting, kReadyExcited)),
    shifts_frame(
        command("RC:", "RC:[<a>]", "take the logical origin back", 64, kAxesOnly, Effect::setting, kReadyExcited)),
    command("D:", "D:<a>{S<spds>F<spdf>R<r>| }", "set speeds S, F and time R", 89, kSpeeds, Effect::setting, kReady),
    command("JD:", "JD:<a>{<u><spd>}", "change the speed of a running jog", 93, kSpeedsWithUnit, Effect::setting,
            kExcited),
    beside_motion(whole_controller(
        command("O:", "O:<s>", "set the general-purpose outputs", 96, kOutputsOnly, Effect::setting, kNothing))),
    of_trigger("T:T", "T:T<a>", "trigger output: every so often", 97, kTriggerTimer),
    of_trigger("T:P", "T:P<a>P<b>", "trigger output: every so many drive pulses of an axis", 98, kTriggerPulses),
    of_trigger("T:S", "T:S", "trigger output: none", 99, kNone),
    of_trigger("T:M", "T:M", "trigger output: one now", 100, kNone),
    of_trigger("T:E", "T:E<a>P<m><b>", "trigger output: every so many scale pulses of an axis in one direction", 101,
               kTriggerScale),
};

}  // namespace

std::span<const CommandRow> settings() { return kRows; }

}  // namespace axisgate::shrc203::rows
