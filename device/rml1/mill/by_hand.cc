#include "device/rml1/mill/by_hand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "device/core/quantity.h"
#include "device/jobs/point.h"
#include "device/rml1/sending/commands.h"

namespace axisgate::rml1 {
namespace {

// Returns the scale of the mill's coordinates, whose pulses are its steps.
Scale scale_of(const Profile& profile) {
  return {.per_pulse = decimal_of(profile.step_mm * 1e6, true).value_or(Decimal{})};
}

// A WholeSteps is a step in whole steps of the mill's coordinates.
struct WholeSteps {
  std::int64_t x = 0, y = 0, z = 0;
};

Result<WholeSteps> whole_steps(const jobs::JogStep& step, const Scale& scale) {
  const Result<std::int64_t> x = to_pulses(step.x, scale), y = to_pulses(step.y, scale), z = to_pulses(step.z, scale);
  for (const auto& one : {x, y, z}) {
    if (!one) return tl::unexpected(one.error());
  }
  return WholeSteps{*x, *y, *z};
}

Result<double> step_speed(const jobs::JogStep& step, const Profile& profile, const Scale& scale) {
  const double lowest = profile.speed.z_minimum, highest = profile.speed.z_maximum;
  if (!step.speed) return std::clamp(profile.speed.z_default, lowest, highest);
  const Result<std::int64_t> steps_per_s = to_pulses_per_second(*step.speed, scale);
  if (!steps_per_s) return tl::unexpected(steps_per_s.error());
  const double speed = static_cast<double>(*steps_per_s) * profile.step_mm;
  if (speed >= lowest && speed <= highest) return speed;
  return fail(Reason::too_fast, fmt::format("{:g} mm/s is no speed of the {}", speed, profile.name),
              fmt::format("use {:g} to {:g} mm/s", lowest, highest));
}

Result<void> check_length(const jobs::Point& step) {
  for (const auto& [axis, mm] : {std::pair('X', step.x), std::pair('Y', step.y), std::pair('Z', step.z)}) {
    if (std::abs(mm) > kFarthestStepMm) {
      return fail(Reason::out_of_range, fmt::format("a step of {:g} mm in {} is too long", mm, axis),
                  fmt::format("where the tool is, is not known: use steps of at most {:g} mm", kFarthestStepMm));
    }
  }
  if (step.z >= -kDeepestStepMm) return {};
  return fail(Reason::out_of_range, fmt::format("a step of {:g} mm down is too long", -step.z),
              fmt::format("where the tool is, is not known: use steps of at most {:g} mm down", kDeepestStepMm));
}

// !MC0 comes first, because !ZZ would start a permitted spindle (guideline 5-2).
Result<HandCommands> step_words(const jobs::JogStep& step, const Profile& profile, double slack) {
  const Scale scale = scale_of(profile);
  const Result<WholeSteps> whole = whole_steps(step, scale);
  if (!whole) return tl::unexpected(whole.error());
  const auto mm = [&profile](std::int64_t steps) { return static_cast<double>(steps) * profile.step_mm; };
  const jobs::Point way{mm(whole->x), mm(whole->y), mm(whole->z)};
  if (const Result<void> good = check_length(way); !good) return tl::unexpected(good.error());
  const Result<double> speed = step_speed(step, profile, scale);
  if (!speed) return tl::unexpected(speed.error());
  if (whole->x == 0 && whole->y == 0 && whole->z == 0) {
    return fail(Reason::out_of_range, "the step is shorter than one of the mill's own",
                fmt::format("the {} moves by {:g} mm", profile.name, profile.step_mm));
  }
  return HandCommands{fmt::format(";!MC0;^PR;!VZ{:g};!ZZ{},{},{};^PA;", *speed, whole->x, whole->y, whole->z),
                      longest_move(std::hypot(way.x, way.y, way.z), *speed, profile, slack)};
}

// After PR, the parameter 0 of !ZO is the present height. After PA, the parameter is a machine coordinate (guideline
// 3-3 !ZO).
Result<HandCommands> surface_words(const jobs::SetZ0& surface, const Profile& profile) {
  if (!surface.at) return HandCommands{";^PR;!ZO0;^PA;"};
  const Result<std::int64_t> at = to_pulses(*surface.at, scale_of(profile));
  if (!at) return tl::unexpected(at.error());
  const double travel = std::round(profile.steps(profile.z_mm));
  const double below_top = profile.up * (profile.top - static_cast<double>(*at));
  if (below_top >= 0 && below_top <= travel) return HandCommands{fmt::format(";^PA;!ZO{};", *at)};
  const double bottom = profile.top - profile.up * travel;
  return fail(Reason::out_of_range, fmt::format("{} is outside of Z's travel", *at),
              fmt::format("use a machine coordinate from {:g} to {:g}", std::min(profile.top, bottom),
                          std::max(profile.top, bottom)));
}

// "Rotation is performed at the time of a command that involves movement", if it is not prohibited (guideline 5-2): so
// !ZZ0,0,0 follows !MC1.
Result<HandCommands> spindle_words(const jobs::TurnSpindle& spindle, const Profile& profile, double slack) {
  if (!spindle.on) return HandCommands{";!MC0;"};
  const std::chrono::duration<double> spin_up(slack * profile.spindle.spin_up_s);
  return HandCommands{";!MC1;^PR;!ZZ0,0,0;^PA;", std::chrono::duration_cast<Duration>(spin_up)};
}

}  // namespace

Result<HandCommands> words_of(const jobs::HandAct& act, const Profile& profile, double slack) {
  if (const auto* step = std::get_if<jobs::JogStep>(&act)) return step_words(*step, profile, slack);
  if (const auto* surface = std::get_if<jobs::SetZ0>(&act)) return surface_words(*surface, profile);
  if (const auto* spindle = std::get_if<jobs::TurnSpindle>(&act)) return spindle_words(*spindle, profile, slack);
  return HandCommands{";!MC0;^PA;" + raise(profile),
                      longest_move(profile.z_mm, profile.speed.z_maximum, profile, slack)};
}

}  // namespace axisgate::rml1
