// Rows of the command table that leave HOST or change the dialect, and the rows that work in the other modes: manual
// 49), 50), 102) to 126).
#include "device/shrc203/command/rows.h"

namespace axisgate::shrc203::rows {
namespace {

// LOAD is listed in manual 49) but not in 37); no answer of ?:MODE names it.
constexpr Parameter kMode{"m", "mode", Kind::choice, "HOST MANUAL REMOTE TEACHING EDIT LOAD TEST"};
constexpr Parameter kFormat{"f", "command format", Kind::choice, "SHOT_FC HIT"};
constexpr Parameter kProgram{"p", "program", Kind::integer, {}, 1, 8};
constexpr Parameter kLine{"n", "line of the program", Kind::integer, {}, 1, 4000};
constexpr Parameter kStep{"p", "what the line does, with its values: M,1,0,0,1000,0,0,0,1,0,5", Kind::text};
constexpr Parameter kPause{"u", "0 pause, 1 go on", Kind::choice, "0 1"};
constexpr Parameter kSignal{"c", "COMP at the program's end: 0 no, 1 yes", Kind::choice, "0 1"};
constexpr Parameter kTriggerSignal{"t", "TRIG at each trigger: 0 no, 1 yes", Kind::choice, "0 1"};
constexpr Parameter kItem{"k",
                          "item: 0 GENERAL, 1 INTERFACE, 2 SENSOR, 3 AXIS, 4 MOTOR DRIVER, 5 SPEED, 6 ORG, "
                          "7 FEEDBACK, 8 SOFT LIMIT",
                          Kind::integer,
                          {},
                          0,
                          8};
constexpr Parameter kSwitch{"n", "number of the switch in its item", Kind::integer, {}, 0, 999};
constexpr Parameter kValue{"s", "its setting, a number", Kind::text};
constexpr Parameter kValues{"s", "all settings of the item: 6,0,1,1,0,1,0,0,0", Kind::text};

constexpr std::array kModeOnly{kMode};
constexpr std::array kFormatOnly{kFormat};
constexpr std::array kProgramOnly{kProgram};
constexpr std::array kLineOnly{kLine};
constexpr std::array kLineAndStep{kLine, kStep};
constexpr std::array kPauseOnly{kPause};
constexpr std::array kSignalOnly{kSignal};
constexpr std::array kTriggerSignalOnly{kTriggerSignal};
constexpr std::array kItemOnly{kItem};
constexpr std::array kItemAndSwitch{kItem, kSwitch};
constexpr std::array kItemSwitchValue{kItem, kSwitch, kValue};
constexpr std::array kItemAndValues{kItem, kValues};

constexpr CommandRow of_program(std::string_view name, std::string_view format, std::string_view description,
                                int section, std::span<const Parameter> parameters, Effect effect = Effect::setting) {
  return in_mode(Mode::program,
                 whole_controller(command(name, format, description, section, parameters, effect, kReady)));
}

// Manual 107) and 108) name no condition: the commands are meant for a running program.
constexpr CommandRow while_it_runs(CommandRow row) {
  row.needs.ready = false;
  return row;
}

constexpr CommandRow of_edit(std::string_view name, std::string_view format, std::string_view description, int section,
                             std::span<const Parameter> parameters) {
  return in_mode(Mode::program_edit, of_program(name, format, description, section, parameters));
}

constexpr CommandRow of_switches(std::string_view name, std::string_view format, std::string_view description,
                                 int section, std::span<const Parameter> parameters) {
  return in_mode(Mode::memory_switches,
                 whole_controller(command(name, format, description, section, parameters, Effect::setting, kNothing)));
}

constexpr CommandRow question_of_switches(std::string_view name, std::string_view format, std::string_view description,
                                          int section, std::span<const Parameter> parameters, std::string_view reply) {
  CommandRow row = question(name, format, description, section, parameters, reply);
  row.separation = Separation::waits;
  return in_mode(Mode::memory_switches, row);
}

constexpr CommandRow ready(CommandRow row) {
  row.needs.ready = true;
  return row;
}

constexpr CommandRow kModesRows[] = {
    means(Meaning::mode_or_format, any_mode(whole_controller(command("MODE:", "MODE:<m>", "change the operation mode",
                                                                     49, kModeOnly, Effect::setting, kReady)))),
    means(Meaning::mode_or_format, whole_controller(command("FMT:", "FMT:<f>", "change the command format", 50,
                                                            kFormatOnly, Effect::setting, kReady))),
    enters(Mode::program, in_mode(Mode::host, of_program("P:R", "P:R", "to program mode", 102, kNone))),
    enters(Mode::host, of_program("P:H", "P:H", "back to HOST", 103, kNone)),
    of_program("P:P", "P:P<p>", "choose a program", 104, kProgramOnly),
    of_program("P:S", "P:S", "run the program", 105, kNone, Effect::motion),
    of_program("P:O", "P:O", "run one line of a program that pauses", 106, kNone, Effect::motion),
    while_it_runs(of_program("P:E", "P:E", "stop the program", 107, kNone)),
    means(Meaning::program_pause,
          while_it_runs(of_program("P:U", "P:U<u>", "pause the program, or go on", 108, kPauseOnly))),
    of_program("P:C", "P:C<c>", "whether COMP is reported at its end", 109, kSignalOnly),
    of_program("P:T", "P:T<t>", "whether TRIG is reported at triggers", 110, kTriggerSignalOnly),
    enters(Mode::program_edit, of_program("P:ON", "P:ON", "to program edit mode", 111, kNone)),
    enters(Mode::program, saves(of_edit("P:OFF", "P:OFF", "save, and back to program mode", 112, kNone))),
    of_edit("P:DEL", "P:DEL,<n>", "delete a line", 113, kLineOnly),
    means(Meaning::program_step, of_edit("P:SET", "P:SET,<n>,<p>", "write a line", 114, kLineAndStep)),
    ready(in_mode(Mode::program_edit, question("P:GET", "P:GET,<n>", "read a line", 115, kLineOnly, "step"))),
    saves(of_edit("P:INIT", "P:INIT", "delete all lines", 116, kNone)),
    enters(Mode::memory_switches,
           ready(in_mode(Mode::host, of_switches("MS:ON", "MS:ON", "to memory switch edit mode", 117, kNone)))),
    enters(Mode::host, saves(of_switches("MS:OFF", "MS:OFF", "save, and back to HOST", 118, kNone))),
    means(Meaning::switches, of_switches("MS:SET", "MS:SET,<k>,<n>,<s>", "set a memory switch", 119, kItemSwitchValue)),
    question_of_switches("MS:GET", "MS:GET,<k>,<n>", "a memory switch", 120, kItemAndSwitch,
                         "number:-999999999:999999999"),
    means(Meaning::switches,
          of_switches("MS:DEF", "MS:DEF,<k>,<n>", "set a memory switch to its initial value", 121, kItemAndSwitch)),
    question_of_switches("MS:DEFR", "MS:DEFR,<k>,<n>", "the initial value of a memory switch", 122, kItemAndSwitch,
                         "number:-999999999:999999999"),
    means(Meaning::switches,
          of_switches("MS:SETK", "MS:SETK,<k>,<s>", "set all memory switches of an item", 123, kItemAndValues)),
    question_of_switches("MS:GETK", "MS:GETK,<k>", "all memory switches of an item", 124, kItemOnly, "numbers"),
    means(Meaning::switches,
          of_switches("MS:DEFK", "MS:DEFK,<k>", "set all of an item to their initial values", 125, kItemOnly)),
    question_of_switches("MS:DEFRK", "MS:DEFRK,<k>", "the initial values of an item", 126, kItemOnly, "numbers"),
};

}  // namespace

std::span<const CommandRow> other_modes() { return kModesRows; }

}  // namespace axisgate::shrc203::rows
