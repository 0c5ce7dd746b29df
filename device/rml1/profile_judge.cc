#include "device/rml1/profile_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "device/rml1/characters.h"

namespace axisgate::rml1 {
namespace {

// Of fewer different coordinates a common divisor says nothing. Assumed.
constexpr std::size_t kCoordinates = 8;
// Below it every drawing has such a raster.
constexpr std::int64_t kSmallestRaster = 4;

bool same_figure(double a, double b) { return std::abs(a - b) < 1e-9; }

// 1, 2 or 5 of a power of ten: what people draw on.
bool is_round(double mm) {
  const double mantissa = mm / std::pow(10, std::floor(std::log10(mm) + 1e-9));
  return same_figure(mantissa, 1) || same_figure(mantissa, 2) || same_figure(mantissa, 5);
}

// "MDX-50" is no part of "MDX-540", but of "MDX-40A" "MDX-40" is.
std::size_t find_name(std::string_view text, std::string_view name) {
  const auto alike = [](char a, char b) {
    return a == b || (is_letter(a) && is_letter(b) && capital(a) == capital(b));
  };
  const auto found = std::search(text.begin(), text.end(), name.begin(), name.end(), alike);
  const auto at = static_cast<std::size_t>(found - text.begin());
  if (found == text.end()) return std::string_view::npos;
  return at + name.size() < text.size() && is_digit(text[at + name.size()]) ? std::string_view::npos : at;
}

Place place_at(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const auto line = static_cast<std::uint64_t>(std::ranges::count(before, '\n'));
  const std::size_t begin = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return {at, line + 1, at - begin + 1};
}

}  // namespace

void ProfileJudge::begins(std::string_view head) {
  if (find_name(head, profile_.name) != std::string_view::npos) return;
  for (const KnownMachine& other : others_) {
    const std::size_t at = find_name(head, other.name);
    if (at == std::string_view::npos) continue;
    diagnostics_.add(0, Severity::warning, place_at(head, at), "1-1", [&] {
      return fmt::format("the file names the {}, and is checked for the {}: is it the right profile?", other.name,
                         profile_.name);
    });
    return;
  }
}

void ProfileJudge::executed(const Instruction& instruction) {
  if (instruction.row->operation == Operation::plane_speed) {
    judge_speed(instruction, profile_.speed.cutting_maximum, plane_speed_reported_);
  } else if (instruction.row->operation == Operation::height_speed) {
    judge_speed(instruction, profile_.speed.z_maximum, height_speed_reported_);
  }
}

// "When the value of the parameter is the model's capacity or higher, the model's maximum speed is used" (3-1 F).
void ProfileJudge::judge_speed(const Instruction& instruction, double highest, bool& reported) {
  const double speed = instruction.values[0];
  if (instruction.count == 0 || !instruction.given[0] || speed <= highest) return;
  speed_not_reached_ = std::max(speed_not_reached_.value_or(0), speed);
  if (reported) return;
  reported = true;
  diagnostics_.add(0, Severity::warning, instruction.place, instruction.row->section, [&] {
    return fmt::format("{} sets {:g} mm/s; the {} has at most {:g} mm/s, and uses that{}", instruction.row->name, speed,
                       profile_.name, highest, machines_as_fast(speed));
  });
}

std::string ProfileJudge::machines_as_fast(double speed) const {
  std::vector<std::string> names;
  for (const KnownMachine& other : others_) {
    if (same_figure(other.fastest, speed)) names.push_back(other.name);
  }
  if (names.empty()) return {};
  return fmt::format(". It is the highest speed of the {}: is it the right profile?", fmt::join(names, " and the "));
}

// A lift by a whole travel shows the unit.
void ProfileJudge::lifted(double steps, const Instruction& by) {
  const auto travel_of = [steps](double z_mm, double step) { return std::abs(z_mm / step - steps) <= 0.5; };
  if (lift_reported_ || travel_of(profile_.z_mm, profile_.step_mm)) return;
  std::vector<std::string> names;
  double step_mm = 0;
  for (const KnownMachine& other : others_) {
    if (same_figure(other.step_mm, profile_.step_mm) || !travel_of(other.z_mm, other.step_mm)) continue;
    names.push_back(other.name);
    step_mm = other.step_mm;
  }
  if (names.empty()) return;
  lift_reported_ = true;
  diagnostics_.add(0, Severity::warning, by.place, "1-1", [&] {
    return fmt::format(
        "a lift of {:g} steps is the whole travel of the {}, with steps of {} mm; here they are {} mm: is it the right "
        "profile?",
        steps, fmt::join(names, " and the "), step_mm, profile_.step_mm);
  });
}

void ProfileJudge::commanded(const Point& target, const Instruction& by) {
  if (raster_ != 0 && raster_ < kSmallestRaster) return;
  if (!first_) first_ = by.place;
  take_coordinate(target.x);
  take_coordinate(target.y);
}

void ProfileJudge::take_coordinate(double steps) {
  const auto whole = static_cast<std::int64_t>(std::llround(steps));
  raster_ = std::gcd(raster_, whole);
  if (whole != 0 && different_.size() < kCoordinates) different_.insert(whole);
}

// Coordinates that all lie on whole millimetres of another unit, and on none of this one.
void ProfileJudge::finish() {
  if (raster_ < kSmallestRaster || different_.size() < kCoordinates) return;
  const auto raster = static_cast<double>(raster_);
  if (is_round(raster * profile_.step_mm)) return;
  const auto other = std::ranges::find_if(others_, [&](const auto& one) { return is_round(raster * one.step_mm); });
  if (other == others_.end()) return;
  diagnostics_.add(0, Severity::note, *first_, "1-1", [&] {
    return fmt::format(
        "all X and Y are multiples of {} steps: {:g} mm on the {} with steps of {} mm, {:g} mm here: is it the right "
        "profile?",
        raster_, raster * other->step_mm, other->name, other->step_mm, raster * profile_.step_mm);
  });
}

}  // namespace axisgate::rml1
