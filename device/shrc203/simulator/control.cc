// Commands of a person at the simulated device, as lines of text: `help` lists them all.
#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "device/core/control_language.h"
#include "device/shrc203/simulator/axis_set.h"
#include "device/shrc203/simulator/simulator.h"

namespace axisgate::shrc203::simulator {
namespace {

using Done = Result<std::string>;

struct Call {
  Simulator& device;
  TimePoint now;
  std::vector<Argument> arguments;

  std::string_view word(std::size_t place) const { return arguments[place].word; }
  int number(std::size_t place) const { return static_cast<int>(arguments[place].number); }
  std::size_t choice(std::size_t place) const { return static_cast<std::size_t>(arguments[place].number); }
  bool is_on(std::size_t place) const { return word(place) == "on"; }
  Duration seconds(std::size_t place) const { return Duration(std::llround(arguments[place].number * 1e9)); }
};

struct ControlCommand {
  std::string_view usage;  // device/core/control_language.h
  std::string_view meaning;
  Done (*carry_out)(const Call& call);
};

constexpr std::array kNumbers = {
    NumberField{"AXIS", 1, kAxes},
    NumberField{"NUMBER", 0, 63},  // IN1 to IN6 as bits (manual 95) I:)
    NumberField{"MILLISECONDS", 0, 60'000},
    NumberField{"SECONDS", 0, 3600, true},
};

const ControlLanguage& language();

Done help(const Call& call) { return language().help(call.arguments); }

Done excitation(const Call& call) {
  call.device.set_excitation(call.number(0), call.is_on(1), call.now);
  return {};
}

Done limit(const Call& call) {
  call.device.set_limit(call.number(0), call.word(1) == "cw" ? 1 : -1, call.is_on(2), call.now);
  return {};
}

// Errors and flags in the order of the usage.
constexpr std::array kErrors = {AxisError::scale,  AxisError::disconnection, AxisError::overflow, AxisError::hunting,
                                AxisError::system, AxisError::overheat,      AxisError::s9};
constexpr std::array kFlags = {
    AxisFlag::config,          AxisFlag::io_overload,       AxisFlag::power_overload,     AxisFlag::heat,
    AxisFlag::out_of_position, AxisFlag::cw_software_limit, AxisFlag::ccw_software_limit, AxisFlag::near_sensor};

Done error(const Call& call) {
  call.device.set_error(call.number(0), kErrors.at(call.choice(1)), call.is_on(2), call.now);
  return {};
}

Done flag(const Call& call) {
  call.device.set_flag(call.number(0), kFlags.at(call.choice(1)), call.is_on(2), call.now);
  return {};
}

Done inputs(const Call& call) {
  call.device.advance(call.now);
  call.device.set_inputs(call.number(0));
  return {};
}

Done outputs(const Call& call) {
  call.device.advance(call.now);
  return std::to_string(call.device.outputs());
}

Done triggers(const Call& call) {
  call.device.advance(call.now);
  return std::to_string(call.device.trigger_pulses());
}

Done sleep(const Call& call) {
  if (call.device.set_sleep(call.is_on(0), call.now)) return {};
  return fail(Reason::axis_busy, "an axis is BUSY, and it falls asleep or wakes only while stationary",
              "wait until `busy` says no, or stop it");
}

Done be_stuck(const Call& call) {
  call.device.be_stuck(call.seconds(0), call.now);
  call.device.advance(call.now);  // with 0 seconds, the delayed replies are sent now
  return {};
}

// Returns one field for the named axis, or for each of the three axes.
template <class Field>
Done each_axis(const Call& call, Field field) {
  call.device.advance(call.now);
  if (!call.arguments.empty()) return field(call.number(0));
  return fmt::format("{} {} {}", field(1), field(2), field(3));
}

Done position(const Call& call) {
  return each_axis(call, [&](int axis) { return std::to_string(call.device.position(axis)); });
}

Done busy(const Call& call) {
  return each_axis(call, [&](int axis) { return std::string(call.device.busy(axis) ? "yes" : "no"); });
}

constexpr std::array kControlCommands = {
    ControlCommand{"help [COMMAND]", "all commands, or what one does", help},
    ControlCommand{"mode HOST|MANUAL|REMOTE|TEACHING|EDIT|TEST", "the mode, as chosen at the panel (manual 37) ?:MODE)",
                   [](const Call& call) -> Done {
                     call.device.set_mode(call.word(0), call.now);
                     return {};
                   }},
    ControlCommand{"dialect SHOT_FC|HIT", "the command format, as chosen at the panel (manual 38) ?:FMT)",
                   [](const Call& call) -> Done {
                     call.device.set_format(call.word(0), call.now);
                     return {};
                   }},
    ControlCommand{"emergency", "presses the button: as L:E (manual 66)); BEC: and excitation bring it back",
                   [](const Call& call) -> Done {
                     call.device.press_emergency(call.now);
                     return {};
                   }},
    ControlCommand{"excitation AXIS on|off", "the motor's current (manual 33) ?:C); off stops the axis", excitation},
    ControlCommand{"limit AXIS cw|ccw on|off", "a limit sensor (manual 5), bits 20, 21); on stops what moves into it",
                   limit},
    ControlCommand{
        "error AXIS scale|disconnection|overflow|hunting|system|overheat|s9 on|off",
        "stops the axis: S1, S2, S4, S3, S7, S10 (manual 5), bits 3, 4, 5, 7, 13, 15), and S9, which has no bit",
        error},
    ControlCommand{
        "flag AXIS config|io_overload|power_overload|heat|out_of_position|cw_software_limit|ccw_software_limit|near "
        "on|off",
        "the other bits of manual 5): 10, 11, 12, 14, 16 (17 while BUSY), 22, 23, 24; 22 and 23 stop the axis once",
        flag},
    ControlCommand{"inputs NUMBER", "what IN1 to IN6 are given, as I: reports it (manual 95))", inputs},
    ControlCommand{"outputs", "what OUT1 to OUT6 give, as ?:O reports it (manual 26))", outputs},
    ControlCommand{"triggers", "how many pulses the trigger output has output up to now (manual 97) to 101))",
                   triggers},
    ControlCommand{"sleep on|off", "as SLEEP: (manual 47)); only while stationary", sleep},
    ControlCommand{"power cycle", "off and on: as RESET: (manual 46)); the stages stay where they are",
                   [](const Call& call) -> Done {
                     call.device.power_cycle(call.now);
                     return {};
                   }},
    ControlCommand{"unplug SECONDS", "the cable: what is sent either way is lost for so long; 0 plugs it in again",
                   [](const Call& call) -> Done {
                     call.device.be_unplugged(call.seconds(0), call.now);
                     return {};
                   }},
    ControlCommand{"delay MILLISECONDS", "from now on each line is carried out and answered so much later",
                   [](const Call& call) -> Done {
                     call.device.set_answer_delay(std::chrono::milliseconds(call.number(0)), call.now);
                     return {};
                   }},
    ControlCommand{"stuck SECONDS", "reads and writes nothing for so long, then all of it comes; 0 ends it", be_stuck},
    ControlCommand{"position [AXIS]", "the command counter, in pulses", position},
    ControlCommand{"busy [AXIS]", "whether it moves, settles or waits: yes or no", busy},
};

const ControlLanguage& language() {
  static const ControlLanguage all = [] {
    std::vector<ControlUsage> usages;
    for (const ControlCommand& command : kControlCommands) usages.push_back({command.usage, command.meaning});
    return ControlLanguage(std::move(usages), kNumbers);
  }();
  return all;
}

}  // namespace

Result<std::string> Simulator::operate(std::string_view line, TimePoint now) {
  auto call = language().read(line);
  if (!call) return tl::unexpected(std::move(call.error()));
  return kControlCommands.at(call->command).carry_out({*this, now, std::move(call->arguments)});
}

}  // namespace axisgate::shrc203::simulator
