#include "device/rml1/shades.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace axisgate::rml1 {
namespace {

double depth(const Strokes::Stroke& stroke) { return -std::min({stroke.from[2], stroke.to[2], 0.0F}); }

}  // namespace

const std::array<const char*, kShades> kShadeColours = {"#c3cbd3", "#9aa5b1", "#e6007e", "#fdae61",
                                                        "#f98e52", "#ef6548", "#d7301f", "#a50f15",
                                                        "#7a0177", "#54278f", "#1f005c", "#00a86b"};

Shades::Shades(const Strokes& strokes, double step_mm) : step_mm_(step_mm) {
  set_levels(strokes);
  for (const Strokes::Stroke& stroke : strokes.all()) used_[static_cast<std::size_t>(of(stroke))] = true;
}

long Shades::hundredths(double steps) const { return std::lround(steps * step_mm_ * 100); }

// A few depths are far apart in colour, too; a single one is in the middle.
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
      levels_.push_back({shallowest + (deeper + kDepths - 1) / kDepths, kShallowest + range - 1});
    }
    return;
  }
  const auto last = static_cast<int>(depths.size()) - 1;
  int index = 0;
  for (const long one : depths) {
    levels_.push_back({one, kShallowest + (last == 0 ? kDepths / 2 : index * (kDepths - 1) / last)});
    ++index;
  }
}

std::size_t Shades::level_of(const Strokes::Stroke& stroke) const {
  return static_cast<std::size_t>(std::ranges::lower_bound(levels_, hundredths(depth(stroke)), {}, &Level::hundredths) -
                                  levels_.begin());
}

int Shades::of(const Strokes::Stroke& stroke) const {
  if (stroke.kind == Strokes::Kind::travel) return kTravel;
  if (stroke.kind == Strokes::Kind::left_out) return kLeftOut;
  if (stroke.done == Strokes::Done::yes) return kDone;
  return stroke.done == Strokes::Done::perhaps ? kPerhapsDone : levels_[level_of(stroke)].shade;
}

std::vector<Shades::Entry> Shades::legend() const {
  std::vector<Entry> entries;
  const auto add = [&](int shade, std::string text) {
    if (used_[static_cast<std::size_t>(shade)]) entries.push_back({shade, std::move(text)});
  };
  add(kTravel, "travel");
  for (const Level& level : levels_) {
    const double mm = static_cast<double>(level.hundredths) / 100;
    add(level.shade, fmt::format("{}{:.2f} mm deep", ranges_ ? "to " : "", mm));
  }
  add(kLeftOut, "not driven");
  add(kDone, "done");
  add(kPerhapsDone, "perhaps done");
  return entries;
}

}  // namespace axisgate::rml1
