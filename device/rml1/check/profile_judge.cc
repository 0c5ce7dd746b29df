#include "device/rml1/check/profile_judge.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "device/rml1/language/characters.h"

namespace axisgate::rml1 {
namespace {

// Assumed: with fewer different coordinates a common divisor shows nothing.
constexpr std::size_t kCoordinates = 8;
// Smaller rasters occur in every drawing.
constexpr std::int64_t kSmallestRaster = 4;
// Assumed: a job with fewer paths is a trial, whose depths and lifts show nothing.
constexpr std::uint64_t kPaths = 20;
// Odds of 3 to 1 from which the job counts as written in the other unit. Assumed: this limit separates the jobs of
// tests/jobs.
constexpr double kCertain = 1.1;
// Assumed weight of a lift by a whole travel: some drivers lift by the same number of steps on all machines.
constexpr double kTravelOdds = 2.5;

bool same_figure(double a, double b) { return std::abs(a - b) < 1e-9; }

// Reports whether the length is 1, 2 or 5 times a power of ten, as people choose for drawings.
bool is_round(double mm) {
  const double mantissa = mm / std::pow(10, std::floor(std::log10(mm) + 1e-9));
  return same_figure(mantissa, 1) || same_figure(mantissa, 2) || same_figure(mantissa, 5);
}

// Returns the position of a machine's name. A name does not match if a digit follows: "MDX-5" is not found in "MDX-50",
// but "MDX-40" is found in "MDX-40A".
std::size_t find_name(std::string_view text, std::string_view name) {
  const auto alike = [](char a, char b) {
    return a == b || (is_letter(a) && is_letter(b) && capital(a) == capital(b));
  };
  const auto found = std::search(text.begin(), text.end(), name.begin(), name.end(), alike);
  const auto at = static_cast<std::size_t>(found - text.begin());
  if (found == text.end()) return std::string_view::npos;
  return at + name.size() < text.size() && is_digit(text[at + name.size()]) ? std::string_view::npos : at;
}

jobs::Place place_at(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const auto line = static_cast<std::uint64_t>(std::ranges::count(before, '\n'));
  const std::size_t begin = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  return {at, line + 1, at - begin + 1};
}

}  // namespace

// Keeps the first suspicion. A named machine (made_for_) takes precedence over everything that the job shows.
void ProfileJudge::suspect(std::string why, const std::vector<std::string>& names, double step_mm,
                           const jobs::Place& place) {
  if (suspicion_ || !made_for_.empty()) return;
  suspicion_ = Suspicion{std::move(why), fmt::format("{}", fmt::join(names, " or ")), step_mm, place};
}

void ProfileJudge::begins(std::string_view head) {
  named_ = find_name(head, profile_.name) != std::string_view::npos;
  if (named_) return;
  for (const KnownMachine& other : others_) {
    const std::size_t at = find_name(head, other.name);
    if (at == std::string_view::npos) continue;
    return suspect("the file names it", {other.name}, other.step_mm, place_at(head, at));
  }
}

void ProfileJudge::executed(const Instruction& instruction) {
  if (instruction.row->operation == Operation::plane_speed) {
    judge_speed(instruction, profile_.speed.cutting_maximum, plane_speed_reported_);
  } else if (instruction.row->operation == Operation::height_speed) {
    judge_speed(instruction, profile_.speed.z_maximum, height_speed_reported_);
  }
}

// Warns if a command sets a speed above the machine's: "When the value of the parameter is the model's capacity or
// higher, the model's maximum speed is used" (3-1 F).
void ProfileJudge::judge_speed(const Instruction& instruction, double highest, bool& reported) {
  const double speed = instruction.values[0];
  if (instruction.count == 0 || !instruction.given[0] || speed <= highest) return;
  speed_not_reached_ = std::max(speed_not_reached_.value_or(0), speed);
  if (reported) return;
  reported = true;
  diagnostics_.warn(Warning::too_fast, instruction.place, instruction.row->section, [&] {
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
  if (steps <= 0) return;
  clues_.lifted(steps);
  const auto travel_of = [steps](double z_mm, double step) { return std::abs(z_mm / step - steps) <= 0.5; };
  own_travel_ = own_travel_ || travel_of(profile_.z_mm, profile_.step_mm);
  if (own_travel_ || travel_) return;
  for (const KnownMachine& other : others_) {
    if (same_figure(other.step_mm, profile_.step_mm) || !travel_of(other.z_mm, other.step_mm)) continue;
    if (!travel_) travel_ = Suspicion{fmt::format("a lift of {:g} steps is its whole travel", steps), "", 0, by.place};
    travel_->step_mm = other.step_mm;
    travel_->names += (travel_->names.empty() ? "" : " or ") + other.name;
  }
}

void ProfileJudge::deepened(const jobs::Point& target, const Instruction& by) {
  clues_.deep(-target.z);
  if (!deep_) deep_ = by.place;
}

void ProfileJudge::commanded(const jobs::Point& target, const Instruction& by) {
  ++paths_;
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

void ProfileJudge::suspect_as_said() {
  const auto other = std::ranges::find(others_, made_for_, &KnownMachine::name);
  if (made_for_ == profile_.name || other == others_.end()) return;
  suspicion_ = Suspicion{"its sender says so", other->name, other->step_mm, {}};
}

// Returns the natural logarithm of the odds.
double ProfileJudge::odds_of(double step_mm) const {
  const bool is_travel = travel_ && same_figure(step_mm, travel_->step_mm);
  return clues_.odds(step_mm, profile_.step_mm) + (is_travel ? kTravelOdds : 0) - (own_travel_ ? kTravelOdds : 0);
}

// Suspects a unit in which the depths and lifts are usual, if they are not usual in this one.
void ProfileJudge::suspect_by_clues() {
  if (named_ || (paths_ < kPaths && !travel_)) return;
  double best = kCertain, step_mm = 0;
  for (const KnownMachine& other : others_) {
    if (same_figure(other.step_mm, profile_.step_mm) || odds_of(other.step_mm) <= best) continue;
    best = odds_of(other.step_mm);
    step_mm = other.step_mm;
  }
  if (travel_ && same_figure(step_mm, travel_->step_mm)) suspicion_ = suspicion_ ? suspicion_ : travel_;
  std::vector<std::string> names;
  for (const KnownMachine& other : others_) {
    if (same_figure(other.step_mm, step_mm)) names.push_back(other.name);
  }
  if (!names.empty() && deep_) suspect("its depths and lifts are usual there", names, step_mm, *deep_);
}

void ProfileJudge::finish(const jobs::Extent& extent) {
  made_for_.empty() ? suspect_by_clues() : suspect_as_said();
  if (!suspicion_) return judge_raster();
  diagnostics_.warn(Warning::made_for_another_mill, suspicion_->place, "1-1", [&] {
    const double factor = suspicion_->step_mm / profile_.step_mm;
    return fmt::format("made for the {}, as {}: there {}; here, as {}, {}", suspicion_->names, suspicion_->why,
                       size_text(scaled(extent, factor)), profile_.name, size_text(extent));
  });
}

// Notes coordinates that all lie on a round raster of another unit, and on none of this one.
void ProfileJudge::judge_raster() {
  if (raster_ < kSmallestRaster || different_.size() < kCoordinates) return;
  const auto raster = static_cast<double>(raster_);
  if (is_round(raster * profile_.step_mm)) return;
  const auto other = std::ranges::find_if(others_, [&](const auto& one) { return is_round(raster * one.step_mm); });
  if (other == others_.end()) return;
  diagnostics_.note(*first_, "1-1", [&] {
    return fmt::format(
        "all X and Y are multiples of {} steps: {:g} mm on the {} with steps of {} mm, {:g} mm here: is it the right "
        "profile?",
        raster_, raster * other->step_mm, other->name, other->step_mm, raster * profile_.step_mm);
  });
}

}  // namespace axisgate::rml1
