#include "device/rml1/machine/clip.h"

#include <algorithm>
#include <array>
#include <limits>

namespace axisgate::rml1 {
namespace {

// Part of a straight path on which X and Y are inside: from `enter` to `leave`, as fractions of its length; empty if
// enter > leave.
struct Span {
  double enter = 0, leave = 1;
  bool any() const { return enter <= leave; }
};

void cut(Span& span, double from, double to, double lowest, double highest) {
  const double way = to - from;
  if (way == 0) {
    if (from < lowest || from > highest) span = {1, 0};
    return;
  }
  const double a = (lowest - from) / way, b = (highest - from) / way;
  span.enter = std::max(span.enter, std::min(a, b));
  span.leave = std::min(span.leave, std::max(a, b));
}

Span inside(const Box& box, const jobs::Point& from, const jobs::Point& to) {
  Span span;
  cut(span, from.x, to.x, box.lowest.x, box.highest.x);
  cut(span, from.y, to.y, box.lowest.y, box.highest.y);
  return span;
}

// Longest distance of two places that count as the same. The place where the path leaves and the place where it returns
// are computed from different ends.
constexpr double kSamePlace = 1e-6;  // steps

bool same_plane(const jobs::Point& a, const jobs::Point& b) {
  return std::abs(a.x - b.x) < kSamePlace && std::abs(a.y - b.y) < kSamePlace;
}

jobs::Point at(const jobs::Point& from, const jobs::Point& to, double part) {
  if (part <= 0) return from;
  return part >= 1 ? to : from + (to - from) * part;
}

}  // namespace

jobs::Point Box::held(const jobs::Point& p) const {
  return {std::clamp(p.x, lowest.x, highest.x), std::clamp(p.y, lowest.y, highest.y),
          std::clamp(p.z, lowest.z, highest.z)};
}

void find_left_out(const Box& box, const jobs::Point& from, const jobs::Point& to, const Piecewise& left_out) {
  const double bottom = box.lowest.z;
  if (box.over(from) && box.over(to) && from.z >= bottom && to.z >= bottom) return;
  Span span = inside(box, from, to);
  if (span.any()) cut(span, from.z, to.z, bottom, std::numeric_limits<double>::infinity());
  if (!span.any()) return left_out(from, to);
  if (span.enter > 0) left_out(from, at(from, to, span.enter));
  if (span.leave < 1) left_out(at(from, to, span.leave), to);
}

void Clipper::move_to(const jobs::Point& target, const Driven& driven) {
  const jobs::Point from = commanded_;
  commanded_ = target;
  // The usual case.
  if (!outside_ && box_.over(target)) return follow(from, target, driven);
  const Span span = inside(box_, from, target);
  if (!span.any()) return;
  if (outside_) come_back(at(from, target, span.enter), driven);
  follow(at(from, target, outside_ ? span.enter : 0), at(from, target, span.leave), driven);
  outside_ = !box_.over(target);
}

// Follows a commanded path whose X and Y are inside all along. The tool is at the commanded place, except that bottom
// and top limit its height.
void Clipper::follow(const jobs::Point& from, const jobs::Point& to, const Driven& driven) {
  const double way = to.z - from.z;
  std::array<double, 2> crossings = {1, 1};
  if (way != 0) {
    const double bottom = (box_.lowest.z - from.z) / way, top = (box_.highest.z - from.z) / way;
    crossings = {std::min(bottom, top), std::max(bottom, top)};
  }
  double begin = 0;
  for (const double end : {crossings[0], crossings[1], 1.0}) {
    if (end <= begin || end > 1) continue;
    drive(Piece::commanded, box_.held(at(from, to, end)), driven);
    begin = end;
  }
}

// Returns to the commanded path. "Raise all the way up once, move only the X and Y axes, then lower only the Z axis"
// (C); if X and Y are the same, "move only the Z axis" (B 1).
void Clipper::come_back(const jobs::Point& place, const Driven& driven) {
  jobs::Point inner = box_.held(place);
  if (same_plane(inner, tool_)) {
    inner = {tool_.x, tool_.y, inner.z};
  } else {
    drive(Piece::raise, {tool_.x, tool_.y, box_.highest.z}, driven);
    drive(Piece::across, {inner.x, inner.y, box_.highest.z}, driven);
  }
  drive(Piece::descent, inner, driven);
}

void Clipper::drive_to(const jobs::Point& target, const Driven& driven) {
  drive(Piece::commanded, box_.held(target), driven);
  commanded_ = tool_;
  outside_ = false;
}

void Clipper::shift(double z, const Box& box) {
  box_ = box;
  commanded_.z += z;
  tool_.z = std::clamp(tool_.z + z, box.lowest.z, box.highest.z);
}

void Clipper::drive(Piece piece, const jobs::Point& to, const Driven& driven) {
  if (to == tool_) return;
  const jobs::Point from = tool_;
  tool_ = to;
  driven(piece, from, to);
}

}  // namespace axisgate::rml1
