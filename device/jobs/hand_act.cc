#include "device/jobs/hand_act.h"

#include <fmt/format.h>

#include <utility>

namespace axisgate::jobs {
namespace {

std::string amount_text(const Quantity& amount) {
  return fmt::format("{} {}", to_string(amount.value), symbol(amount.unit));
}

std::string step_text(const JogStep& step) {
  std::string text = "jog by";
  const char* between = " ";
  for (const auto& [axis, amount] : {std::pair('X', step.x), std::pair('Y', step.y), std::pair('Z', step.z)}) {
    if (amount.value.digits == 0) continue;
    text += fmt::format("{}{} {}", between, axis, amount_text(amount));
    between = ", ";
  }
  return step.speed ? fmt::format("{} at {}/s", text, amount_text(*step.speed)) : text;
}

std::string surface_text(const SetZ0& surface) {
  if (!surface.at) return "set Z0 to where the tool is";
  return fmt::format("set Z0 to the machine coordinate {}", amount_text(*surface.at));
}

}  // namespace

std::string text_of(const HandAct& act) {
  if (const auto* step = std::get_if<JogStep>(&act)) return step_text(*step);
  if (const auto* surface = std::get_if<SetZ0>(&act)) return surface_text(*surface);
  if (const auto* spindle = std::get_if<TurnSpindle>(&act))
    return spindle->on ? "start the spindle" : "stop the spindle";
  return "raise the tool";
}

}  // namespace axisgate::jobs
