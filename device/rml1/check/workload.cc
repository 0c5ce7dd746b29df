#include "device/rml1/check/workload.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace axisgate::rml1 {
namespace {

constexpr double kAssumedToolMm = 2;

}  // namespace

Workload::Workload(const Profile& profile, std::optional<double> tool_mm)
    : step_mm_(profile.step_mm),
      tool_known_(tool_mm.has_value()),
      map_(profile.steps(tool_mm.value_or(kAssumedToolMm)), profile.steps(std::hypot(profile.x_mm, profile.y_mm))) {}

void Workload::continues(Workload& before) {
  map_ = std::move(before.map_);
  map_.change_tool();
}

double Workload::moved(const Move& move, double speed) {
  if (!move.cuts() || move.lifts()) return 0;
  const jobs::Point from = sunk(move.from, move.to), to = sunk(move.to, move.from);
  const HeightMap::Taken taken = map_.cut(from, to);
  const bool plunges = from.x == to.x && from.y == to.y;
  Section& one = section(plunges, speed, move.place);
  one.cutting_mm += length(to - from) * step_mm_;
  one.deepest_mm = std::max({one.deepest_mm, -from.z * step_mm_, -to.z * step_mm_});
  one.pass_mm = std::max(one.pass_mm, taken.depth * step_mm_);
  if (map_.full()) {
    for (Section& each : sections_) each.removed_mm3.reset();
  }
  if (one.removed_mm3) *one.removed_mm3 += taken.volume * step_mm_ * step_mm_ * step_mm_;
  return taken.depth * step_mm_;
}

Section& Workload::section(bool plunges, double speed, const jobs::Place& place) {
  const auto wanted = [&](const Section& one) { return one.plunges == plunges && one.speed == speed; };
  auto found = std::ranges::find_if(sections_, wanted);
  if (found == sections_.end() && sections_.size() + 1 >= kSections) {
    // The last section collects all further speeds.
    found = std::ranges::find(sections_, 0.0, &Section::speed);
    speed = 0;
    plunges = false;
  }
  if (found != sections_.end()) return *found;
  sections_.push_back({.plunges = plunges, .speed = speed, .first = place});
  if (tool_known_ && !map_.full()) sections_.back().removed_mm3 = 0;
  return sections_.back();
}

}  // namespace axisgate::rml1
