#include "device/shrc203/command/trigger.h"

#include <string>
#include <utility>
#include <vector>

#include "device/shot/command/reply.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {
namespace {

using Target = Trigger::Target;

std::pair<std::string_view, Arguments> written(const Trigger& trigger) {
  const std::string interval = std::to_string(trigger.interval), axis = std::to_string(trigger.axis);
  switch (trigger.target) {
    case Target::none:
      return {"T:S", {}};
    case Target::timer:
      return {"T:T", Arguments().add("a", interval)};
    case Target::drive_pulses:
      return {"T:P", Arguments().add("a", axis).add("b", interval)};
    case Target::scale_plus:
    case Target::scale_minus:
      break;
  }
  const char* sign = trigger.target == Target::scale_plus ? "+" : "-";
  return {"T:E", Arguments().add("a", axis).add("m", sign).add("b", interval)};
}

}  // namespace

Command trigger_command(const Trigger& trigger) {
  const auto [name, arguments] = written(trigger);
  return model().make(name, arguments);
}

Result<std::string> trigger_line(const Trigger& trigger) {
  const auto [name, arguments] = written(trigger);
  return encode(model().row(name), arguments);
}

std::optional<Trigger> trigger_of(const Command& command) {
  const auto number = [&](std::string_view letter) {
    return parse_integer(command.arguments.first(letter).value_or("0")).value_or(0);
  };
  const auto& name = command.row->name;
  if (name == "T:S") return Trigger{};
  if (name == "T:T") return Trigger{Target::timer, 0, number("a")};
  if (name == "T:P") return Trigger{Target::drive_pulses, static_cast<int>(number("a")), number("b")};
  if (name != "T:E") return {};
  const bool minus = command.arguments.first("m") == "-";
  return Trigger{minus ? Target::scale_minus : Target::scale_plus, static_cast<int>(number("a")), number("b")};
}

}  // namespace axisgate::shrc203
