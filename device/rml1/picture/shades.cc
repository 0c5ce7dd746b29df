#include "device/rml1/picture/shades.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace axisgate::rml1 {
namespace {

double depth(const Strokes::Stroke& stroke) { return -std::min({stroke.from[2], stroke.to[2], 0.0F}); }

}  // namespace

const std::array<const char*, kShades> kShadeColours = {
    "#c3cbd3", "#9aa5b1", "#e6007e", "#00a86b",  // done, travel, not driven, perhaps done
    "#fdae61", "#f98e52", "#ef6548", "#d7301f", "#a50f15", "#7a0177", "#54278f", "#1f005c",  // parts 1, 3, ...
    "#a6dbe0", "#7cc8d2", "#4fb0c6", "#2e94b6", "#1f78a0", "#175d84", "#104466", "#082a44"   // parts 2, 4, ...
};

Shades::Shades(const Strokes& strokes, double step_mm) : step_mm_(step_mm), parts_(strokes.parts()) {
  set_levels(strokes);
  for (const Strokes::Stroke& stroke : strokes.all()) used_[static_cast<std::size_t>(of(stroke))] = true;
}

long Shades::hundredths(double steps) const { return std::lround(steps * step_mm_ * 100); }

// Sets the levels so that a few depths are far apart in colour, too; a single depth is in the middle.
void Shades::set_levels(const Strokes& strokes) {
  std::set<long> depths;
  long shallowest = 0, deepest = 0;
  for (const Strokes::Stroke& stroke : strokes.all()) {
    if (stroke.kind != Strokes::Kind::cut) continue;
    const long one = hundredths(depth(stroke));
    shallowest = deepest == 0 ? one : std::min(shallowest, one);
    deepest = std::max(deepest, one);
    if (depths.size() <= kDepths) depths.insert(hundredths(depth(stroke)));
  }
  ranges_ = depths.size() > kDepths;
  if (ranges_) {
    for (int range = 1; range <= kDepths; ++range) {
      const long deeper = (deepest - shallowest) * range;
      levels_.push_back({shallowest + (deeper + kDepths - 1) / kDepths, range - 1});
    }
    return;
  }
  const auto last = static_cast<int>(depths.size()) - 1;
  int index = 0;
  for (const long one : depths) {
    levels_.push_back({one, last == 0 ? kDepths / 2 : index * (kDepths - 1) / last});
    ++index;
  }
}

int Shades::of_cut(double depth, std::size_t part) const {
  const auto level = std::ranges::lower_bound(levels_, hundredths(depth), {}, &Level::hundredths);
  return kShallowest + static_cast<int>(part % kTints) * kDepths + level->depth;
}

int Shades::of(const Strokes::Stroke& stroke) const {
  if (stroke.kind == Strokes::Kind::travel) return kTravel;
  if (stroke.kind == Strokes::Kind::left_out) return kLeftOut;
  if (stroke.done == Strokes::Done::yes) return kDone;
  return stroke.done == Strokes::Done::perhaps ? kPerhapsDone : of_cut(depth(stroke), stroke.part);
}

// Adds texts such as "part 2: 0.10 mm deep", or "0.10 mm deep" for a job without parts.
void Shades::add_depths(std::vector<Entry>& entries, int tint) const {
  std::vector<std::size_t> parts;
  for (auto part = static_cast<std::size_t>(tint); part < parts_; part += kTints) parts.push_back(part + 1);
  const std::string of_part =
      parts_ == 1 ? "" : fmt::format("part{} {}: ", parts.size() == 1 ? "" : "s", fmt::join(parts, ", "));
  for (const Level& level : levels_) {
    const int shade = kShallowest + tint * kDepths + level.depth;
    if (!used_[static_cast<std::size_t>(shade)]) continue;
    const double mm = static_cast<double>(level.hundredths) / 100;
    entries.push_back({shade, fmt::format("{}{}{:.2f} mm deep", of_part, ranges_ ? "to " : "", mm)});
  }
}

std::vector<Shades::Entry> Shades::legend() const {
  std::vector<Entry> entries;
  const auto add = [&](int shade, std::string text) {
    if (used_[static_cast<std::size_t>(shade)]) entries.push_back({shade, std::move(text)});
  };
  add(kTravel, "travel");
  for (int tint = 0; tint < kTints; ++tint) add_depths(entries, tint);
  add(kLeftOut, "not driven");
  add(kDone, "done");
  add(kPerhapsDone, "perhaps done");
  return entries;
}

}  // namespace axisgate::rml1
