#include "device/shrc203/command/builders.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <utility>
#include <vector>

#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203::commands {
namespace {

struct Asked {
  Question question;
  std::string_view line;
};

// Lines of the questions, in the order of the enumerators.
constexpr Asked kAsked[] = {
    {Question::identity, "*IDN?"},          // 1)
    {Question::ready, "!:"},                // 2)
    {Question::each_ready, "!:S"},          // 3)
    {Question::positions, "Q:SPC"},         // 5)
    {Question::scale_counters, "Q:SPE"},    // 5)
    {Question::scale_resolution, "?:R"},    // 9)
    {Question::pulse_length, "?:P"},        // 10)
    {Question::speeds, "?:D"},              // 13)
    {Question::origin_speeds, "?:B"},       // 17)
    {Question::setpoint_m, "?:M"},          // 18)
    {Question::setpoint_mp, "?:MP"},        // 19)
    {Question::setpoint_a, "?:A"},          // 20)
    {Question::setpoint_ap, "?:AP"},        // 21)
    {Question::setpoint_e, "?:E"},          // 22)
    {Question::setpoint_ep, "?:EP"},        // 23)
    {Question::setpoint_k, "?:K"},          // 24)
    {Question::setpoint_kp, "?:KP"},        // 25)
    {Question::setpoint_j, "?:J"},          // 31)
    {Question::wait_set, "?:WT"},           // 28)
    {Question::input_wait_set, "?:WI"},     // 29)
    {Question::outputs, "?:O"},             // 26)
    {Question::inputs, "I:"},               // 95)
    {Question::auto_config, "?:ACS"},       // 32)
    {Question::excitation, "?:C"},          // 33)
    {Question::sleep, "?:SLEEP"},           // 35)
    {Question::mode, "?:MODE"},             // 37)
    {Question::format, "?:FMT"},            // 38)
    {Question::previous_command, "?:CMD"},  // 40)
    {Question::program, "?:L"},             // 41)
    {Question::trigger, "?:T"},             // 42)
    {Question::serial_number, "?:SN"},      // 43)
    {Question::axes, "?:AXIS"},             // 44)
};

consteval bool in_order() {
  for (std::size_t place = 0; place < std::size(kAsked); ++place) {
    if (kAsked[place].question != static_cast<Question>(place)) return false;
  }
  return std::size(kAsked) == static_cast<std::size_t>(Question::axes) + 1;
}
static_assert(in_order());

// Polls ask very often, so the lines are parsed only once.
const Command& command_of(Question question) {
  static const std::vector<Command> commands = [] {
    std::vector<Command> all;
    for (const auto& asked : kAsked) {
      auto command = model().parse(asked.line);
      if (!command) std::abort();
      all.push_back(*std::move(command));
    }
    return all;
  }();
  return commands[static_cast<std::size_t>(question)];
}

template <class ByAxis>
AxisSet axes_of(const ByAxis& values) {
  AxisSet axes;
  for (const auto& [axis, value] : values) axes.add(axis);
  return axes;
}

Arguments& add_speed(Arguments& arguments, const SpeedSetting& speed) {
  return arguments.speeds(speed.minimum, speed.maximum, speed.acceleration_ms);
}

Arguments speed_arguments(const Speeds& speeds) {
  Arguments arguments;
  arguments.axes(axes_of(speeds));
  for (const auto& [axis, speed] : speeds) add_speed(arguments, speed);
  return arguments;
}

}  // namespace

Command ask(Question question) { return command_of(question); }

std::string_view text(Question question) { return kAsked[static_cast<std::size_t>(question)].line; }

const CommandRow& row_of(Question question) { return *command_of(question).row; }

Question question_of(Register reg) {
  switch (reg) {
    case Register::m:
      return Question::setpoint_m;
    case Register::k:
      return Question::setpoint_k;
    case Register::e:
      return Question::setpoint_e;
    case Register::j:
      return Question::setpoint_j;
    case Register::mp:
      return Question::setpoint_mp;
    case Register::ap:
      return Question::setpoint_ap;
    case Register::kp:
      return Question::setpoint_kp;
    case Register::ep:
      return Question::setpoint_ep;
    case Register::wt:
      return Question::wait_set;
    case Register::wi:
      return Question::input_wait_set;
    case Register::none:
    case Register::a:
      break;
  }
  return Question::setpoint_a;
}

const CommandRow& setter_of(Register reg) {
  const auto row = std::ranges::find_if(model().commands(), [reg](const CommandRow& one) {
    return one.reg == reg && !one.curve && reg != Register::none;
  });
  if (row == model().commands().end()) std::abort();
  return *row;
}

Command set_setpoint(Register reg, const Amounts& amounts, const Speeds& speeds) {
  Arguments arguments;
  arguments.axes(axes_of(amounts));
  for (const auto& [axis, pulses] : amounts) arguments.pulses(pulses);
  for (const auto& [axis, speed] : speeds) add_speed(arguments, speed);
  return model().make(setter_of(reg), arguments);
}

Result<Command> set_curve(CurveForm form, const Arguments& arguments) {
  const auto row = std::ranges::find_if(
      model().commands(), [form](const CommandRow& one) { return one.reg == Register::ep && one.curve == form; });
  auto line = encode(*row, arguments);
  if (!line) return tl::unexpected(line.error());
  return Command{&*row, arguments, *std::move(line)};
}

Command set_jog(const Amounts& directions) {
  Arguments arguments;
  arguments.axes(axes_of(directions));
  for (const auto& [axis, direction] : directions) arguments.add("m", direction < 0 ? "-" : "+");
  return model().make("J:", arguments);
}

Command set_jog_speeds(const Amounts& speeds) {
  Arguments arguments;
  arguments.axes(axes_of(speeds));
  for (const auto& [axis, speed] : speeds) arguments.add("u", "F").add("spd", std::to_string(speed));
  return model().make("JD:", arguments);
}

Command clear_setpoints(AxisSet axes) { return model().make("GC:", axes); }

Command go(AxisSet axes) { return model().make("G:", axes); }

Command home(AxisSet axes) { return model().make("HRT:", axes); }

Command return_to_origin(AxisSet axes) { return model().make("ZRT:", axes); }

Command stop(AxisSet axes) { return model().make("L:", axes); }

Command emergency_stop() { return model().make("L:E"); }

Command ask_saved(Saved kind, std::string number) {
  return model().make(kind == Saved::place ? "PIT:GET" : "PAV:GET", Arguments().add("n", std::move(number)));
}

Command go_to_saved(Saved kind, std::string number) {
  return model().make(kind == Saved::place ? "PIT:GRT" : "PAV:GRT", Arguments().add("n", std::move(number)));
}

Command set_speeds(const Speeds& speeds) { return model().make("D:", speed_arguments(speeds)); }

Command set_origin_speeds(const Speeds& speeds) { return model().make("B:", speed_arguments(speeds)); }

bool can_be_set(const SpeedSetting& speed) {
  return encode(model().row("D:"), speed_arguments({{1, speed}})).has_value();
}

Command set_outputs(int pattern) { return model().make("O:", Arguments().add("s", std::to_string(pattern))); }

Command clear_errors(AxisSet axes) { return model().make("BEC:", axes); }

Command stop_program() { return model().make("P:E"); }

Command leave_program_mode() { return model().make("P:H"); }

Command leave_program_edit() { return model().make("P:OFF"); }

Command leave_switches() { return model().make("MS:OFF"); }

Command ask_all_switches(int item) { return model().make("MS:GETK", Arguments().add("k", std::to_string(item))); }

}  // namespace axisgate::shrc203::commands
