#include "device/jobs/extent.h"

#include <fmt/format.h>

namespace axisgate::jobs {
namespace {

void take(Reach& all, const Reach& one) {
  if (!one.any) return;
  all.take(one.lowest);
  all.take(one.highest);
}

void take(Bounds& all, const Bounds& one) {
  take(all.x, one.x);
  take(all.y, one.y);
  take(all.z, one.z);
}

Reach scaled(const Reach& reach, double factor) { return {reach.any, reach.lowest * factor, reach.highest * factor}; }

Bounds scaled(const Bounds& bounds, double factor) {
  return {scaled(bounds.x, factor), scaled(bounds.y, factor), scaled(bounds.z, factor)};
}

}  // namespace

void Extent::take(const Extent& other) {
  jobs::take(driven, other.driven);
  jobs::take(cut, other.cut);
}

Extent scaled(const Extent& extent, double factor) {
  return {scaled(extent.driven, factor), scaled(extent.cut, factor)};
}

std::string size_text(const Extent& extent) {
  if (!extent.cut.z.any) return "cuts nothing";
  return fmt::format("{:.1f} x {:.1f} mm, {:.2f} mm deep", extent.cut.x.size(), extent.cut.y.size(), extent.deepest());
}

}  // namespace axisgate::jobs
