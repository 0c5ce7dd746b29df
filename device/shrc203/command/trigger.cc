#include "device/shrc203/command/trigger.h"

#include <string>
#include <utility>
#include <vector>

#include "device/shot/command/reply.h"

namespace axisgate::shrc203 {
namespace {

using Target = Trigger::Target;

bool possible(const Trigger& trigger) {
  switch (trigger.target) {
    case Target::none:
      return true;
    case Target::timer:
      return trigger.interval >= 1 && trigger.interval <= 10'000;
    case Target::drive_pulses:
    case Target::scale_plus:
    case Target::scale_minus:
      break;
  }
  return trigger.axis >= 1 && trigger.axis <= kAxisCount && trigger.interval >= 2 && trigger.interval <= 30'000;
}

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

std::optional<Trigger> parse_trigger(std::string_view answer) {
  if (answer == "NS") return Trigger{};
  std::vector<std::int64_t> numbers;
  for (std::string_view rest = answer; !rest.empty();) {
    const auto number = parse_integer(rest.substr(0, rest.find(',')));
    if (!number) return {};
    numbers.push_back(*number);
    const auto comma = rest.find(',');
    rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
    if (comma != std::string_view::npos && rest.empty()) return {};
  }
  if (numbers.empty() || numbers[0] < 0 || numbers[0] > 3) return {};
  Trigger trigger{static_cast<Target>(numbers[0] + 1), 0, 0};
  if (numbers.size() != (trigger.target == Target::timer ? 2u : 3u)) return {};
  trigger.interval = numbers.back();
  if (trigger.target != Target::timer) {
    if (numbers[1] < 1 || numbers[1] > kAxisCount) return {};
    trigger.axis = static_cast<int>(numbers[1]);
  }
  const bool scale = trigger.target == Target::scale_plus || trigger.target == Target::scale_minus;
  if (scale && trigger.interval < 0) trigger.interval = -trigger.interval;
  return possible(trigger) ? std::optional(trigger) : std::nullopt;
}

Command trigger_command(const Trigger& trigger) {
  const auto [name, arguments] = written(trigger);
  return make_command(name, arguments);
}

Result<std::string> trigger_line(const Trigger& trigger) {
  const auto [name, arguments] = written(trigger);
  return encode(command_row(name), arguments);
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
