#include "device/shot/command/trigger_reply.h"

#include <vector>

#include "device/shot/command/reply.h"

namespace axisgate::shot {
namespace {

using Target = Trigger::Target;

bool possible(const Trigger& trigger, AxisSet axes) {
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
  return axes.has(trigger.axis) && trigger.interval >= 2 && trigger.interval <= 30'000;
}

}  // namespace

std::optional<Trigger> parse_trigger(std::string_view answer, AxisSet axes) {
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
    if (numbers[1] < 1 || numbers[1] > axes.count()) return {};
    trigger.axis = static_cast<int>(numbers[1]);
  }
  const bool scale = trigger.target == Target::scale_plus || trigger.target == Target::scale_minus;
  if (scale && trigger.interval < 0) trigger.interval = -trigger.interval;
  return possible(trigger, axes) ? std::optional(trigger) : std::nullopt;
}

}  // namespace axisgate::shot
