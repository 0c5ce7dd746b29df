// Commands of a person at the simulated device, as lines of text: `help` lists them all.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "device/core/control_language.h"
#include "device/rml1/simulator/simulator.h"

namespace axisgate::rml1::simulator {
namespace {

using Done = Result<std::string>;

struct Call {
  Simulator& mill;
  TimePoint now;
  std::vector<Argument> arguments;

  double number(std::size_t place) const { return arguments[place].number; }
  bool is(std::size_t place, std::string_view word) const { return arguments[place].word == word; }
};

struct ControlCommand {
  std::string_view usage;  // format of device/core/control_language.h
  std::string_view meaning;
  Done (*carry_out)(const Call& call);
};

constexpr std::int64_t kStepsMax = 8'388'607;  // guideline 2-3, long

constexpr std::array kNumbers = {
    NumberField{"DEPTH", -kStepsMax - 1, 0},
    NumberField{"HEIGHT", 0, kStepsMax},
    NumberField{"X", 0, kStepsMax},
    NumberField{"Y", 0, kStepsMax},
    NumberField{"Z", -kStepsMax - 1, kStepsMax},
};

const ControlLanguage& language();

Done help(const Call& call) { return language().help(call.arguments); }

Done refuse_outside() {
  return fail(Reason::out_of_range, "this is outside of the work area", "choose a place that the tool can reach");
}

double to_thousandths(double steps) { return std::round(steps * 1000) / 1000 + 0.0; }

Done state(const Call& call) {
  const Simulator::State now = call.mill.state(call.now);
  const auto yes = [](bool is) { return is ? "yes" : "no"; };
  return fmt::format(
      "x={} y={} z={} tool={} spindle={} buffered={} errors={} moving={} paused={} discarding={} power={}",
      to_thousandths(now.tool.x), to_thousandths(now.tool.y), to_thousandths(now.tool.z), now.tool_down ? "down" : "up",
      now.rpm, now.buffered, now.errors, yes(now.moving), now.paused, yes(now.discarding), now.power ? "on" : "off");
}

constexpr std::array kControlCommands = {
    ControlCommand{"help [COMMAND]", "all commands, or what one does", help},
    ControlCommand{"view", "presses the VIEW key: pauses; pressed again, continues, also after !NR (guideline 3-3 !NR)",
                   [](const Call& call) -> Done {
                     call.mill.press_view(call.now);
                     return {};
                   }},
    ControlCommand{"cover open|closed", "the cover over the table",
                   [](const Call& call) -> Done {
                     call.mill.set_cover(call.is(0, "open"), call.now);
                     return {};
                   }},
    ControlCommand{"stop", "the panel's stop: ends the command, stops the spindle, discards the buffer",
                   [](const Call& call) -> Done {
                     call.mill.press_stop(call.now);
                     return {};
                   }},
    ControlCommand{"power on|off", "settings and buffer are lost; the tool, the origin and Z0 stay where they are",
                   [](const Call& call) -> Done {
                     call.mill.set_power(call.is(0, "on"), call.now);
                     return {};
                   }},
    ControlCommand{"z1 DEPTH", "the height of the lowered tool, in steps above Z0 (guideline 3-1 @)",
                   [](const Call& call) -> Done {
                     call.mill.set_z1(call.number(0), call.now);
                     return {};
                   }},
    ControlCommand{"z2 HEIGHT", "the height of the raised tool, in steps above Z0 (guideline 3-1 @)",
                   [](const Call& call) -> Done {
                     call.mill.set_z2(call.number(0), call.now);
                     return {};
                   }},
    ControlCommand{"origin X Y", "the work origin, in steps from the home corner",
                   [](const Call& call) -> Done {
                     if (!call.mill.set_origin(call.number(0), call.number(1), call.now)) return refuse_outside();
                     return {};
                   }},
    ControlCommand{"z0 Z", "Z0, as a machine coordinate (guideline 3-3 !ZO)",
                   [](const Call& call) -> Done {
                     if (!call.mill.set_z0(call.number(0), call.now)) return refuse_outside();
                     return {};
                   }},
    ControlCommand{"state", "the tool in workpiece steps, the spindle in rpm, bytes buffered, errors shown, pause",
                   state},
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

}  // namespace axisgate::rml1::simulator
