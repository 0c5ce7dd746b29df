// Rows of the command table that start, prepare or stop a motion: manual 47), 57) to 88).
#include "device/shrc203/command/rows.h"

namespace axisgate::shrc203::rows {
namespace {

constexpr Parameter kSleep{"s", "0 wake up, 1 sleep", Kind::choice, "0 1"};
constexpr Parameter kWait{"w", "wait, 0 cancels it", Kind::integer, {}, 0, 2550, "0.1 s"};
constexpr Parameter kInput{
    "i", "pattern of inputs IN1 to IN6 as a number, C cancels the wait", Kind::choice,
    "C 0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31 32 "
    "33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63"};
constexpr std::array kSleepOnly{kSleep};
constexpr std::array kWaits{kAxes, kWait};
constexpr std::array kInputs{kAxes, kInput};

constexpr CommandRow waits(Register reg, CommandRow row) {
  row.reg = reg;
  row.reply = "OK|OK_D";
  return row;
}

constexpr CommandRow kMotionRows[] = {
    // Waking up returns the stage to its position before the sleep (manual 47)).
    means(Meaning::sleep, whole_controller(command("SLEEP:", "SLEEP:<s>", "sleep, or wake up", 47, kSleepOnly,
                                                   Effect::motion, kReady))),
    // The end of a wait, or its cancellation, starts the motion in the prebuffer (manual 2. 3)).
    waits(Register::wt,
          command("WT:", "WT:<a>,{<w>|,}", "wait, prebuffer; 0 cancels", 57, kWaits, Effect::motion, kNothing)),
    waits(Register::wi, command("WI:", "WI:<a>,{<i>|,}", "wait for an input pattern, prebuffer; C cancels", 58, kInputs,
                                Effect::motion, kNothing)),
    means(Meaning::mechanical_return,
          command("H:", "H[<m>]:[<a>]", "mechanical origin return", 59, kOriginReturn, Effect::motion, kReadyExcited)),
    means(Meaning::mechanical_return,
          completes(command("HRT:", "HRT[<m>]:[<a>]", "mechanical origin return with completions", 60, kOriginReturn,
                            Effect::motion, kReadyExcited))),
    means(Meaning::logical_return,
          command("Z:", "Z:[<a>]", "return to the logical origin", 61, kAxesOnly, Effect::motion, kReadyExcited)),
    means(Meaning::logical_return,
          completes(command("ZRT:", "ZRT:[<a>]", "return to the logical origin with completions", 62, kAxesOnly,
                            Effect::motion, kReadyExcited))),
    command("L:", "L:[<a>]", "decelerate and stop", 65, kAxesOnly, Effect::stop, kExcited),
    means(Meaning::emergency_stop,
          whole_controller(command("L:E", "L:E", "emergency stop of all axes", 66, kNone, Effect::stop, kNothing))),
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
    means(Meaning::go, completes(whole_controller(command("G", "G", "start what was set, all controllable axes", 85,
                                                          kNone, Effect::motion, kReadyExcited)))),
    means(Meaning::go,
          completes(command("G:", "G:[<a>]", "start what was set", 86, kAxesOnly, Effect::motion, kReadyExcited))),
    means(Meaning::clear_setpoints, command("GC:", "GC:[<a>]", "delete what M, A, E and K have set", 87, kAxesOnly,
                                            Effect::setting, kReadyExcited)),
    means(Meaning::jog, setter("J:", "J:<a>{<m>}", "set a jog: at speed S until it is stopped", 88, kDirections,
                               Register::j, kReadyExcited)),
};

}  // namespace

std::span<const CommandRow> motion() { return kMotionRows; }

}  // namespace axisgate::shrc203::rows
