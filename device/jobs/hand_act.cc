#include "device/jobs/hand_act.h"

#include <fmt/format.h>

#include <utility>

namespace axisgate::jobs {
namespace {

std::string step_text(const JogStep& step) {
  std::string text = "jog by";
  const char* between = " ";
  for (const auto& [axis, mm] : {std::pair('X', step.x_mm), std::pair('Y', step.y_mm), std::pair('Z', step.z_mm)}) {
    if (mm == 0) continue;
    text += fmt::format("{}{} {:g} mm", between, axis, mm);
    between = ", ";
  }
  return step.mm_per_s ? fmt::format("{} at {:g} mm/s", text, *step.mm_per_s) : text;
}

std::string surface_text(const SetZ0& surface) {
  return surface.at ? fmt::format("set Z0 to the machine coordinate {}", *surface.at) : "set Z0 to where the tool is";
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
