#include "device/rml1/simulator/route.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace axisgate::rml1::simulator {
namespace {

constexpr double kSameSteps = 1e-6;

bool same(double a, double b) { return std::abs(a - b) <= kSameSteps; }

struct Line {
  Position from, to;

  Position at(double part) const {
    if (part >= 1) return to;
    return {from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part, from.h + (to.h - from.h) * part};
  }
};

// Narrows `begin` and `end` to the part of a line that lies between 0 and `limit` in one coordinate. Returns false if
// no part is left.
bool narrow(double from, double to, double limit, double& begin, double& end) {
  if (same(from, to)) return from >= -kSameSteps && from <= limit + kSameSteps;
  const auto [enters, leaves] = std::minmax({-from / (to - from), (limit - from) / (to - from)});
  begin = std::max(begin, enters);
  end = std::min(end, leaves);
  return begin <= end;
}

std::optional<std::pair<double, double>> part_above(const WorkArea& area, const Line& line) {
  double begin = 0, end = 1;
  if (!narrow(line.from.x, line.to.x, area.x, begin, end)) return std::nullopt;
  if (!narrow(line.from.y, line.to.y, area.y, begin, end)) return std::nullopt;
  return std::pair(begin, end);
}

class Legs {
 public:
  explicit Legs(const Position& tool) : tool_(tool) {}

  void go(const Position& to, Leg::Kind kind) {
    if (same(to.x, tool_.x) && same(to.y, tool_.y) && same(to.h, tool_.h)) return;
    legs_.push_back({to, kind});
    tool_ = to;
  }

  // Returns to the path as 5-1 B to K say: "Raise the tool all the way up once, move the X and Y axes to the recovery
  // location, then lower only the Z axis"; if X and Y have not moved, "Move only the Z axis".
  void come_back(const Position& at) {
    if (!same(at.x, tool_.x) || !same(at.y, tool_.y)) {
      go({tool_.x, tool_.y, 0}, Leg::Kind::vertical);
      go({at.x, at.y, 0}, Leg::Kind::crossing);
    }
    go(at, Leg::Kind::vertical);
  }

  std::vector<Leg> take() { return std::move(legs_); }

 private:
  Position tool_;
  std::vector<Leg> legs_;
};

}  // namespace

Position WorkArea::nearest(const Position& position) const {
  return {std::clamp(position.x, 0.0, x), std::clamp(position.y, 0.0, y), std::clamp(position.h, -depth, 0.0)};
}

bool WorkArea::holds_xy(const Position& position) const {
  const Position inside = nearest(position);
  return same(inside.x, position.x) && same(inside.y, position.y);
}

std::vector<Leg> route(const WorkArea& area, const Position& from, const Position& to, const Position& tool) {
  const Line line{from, to};
  const auto part = part_above(area, line);
  if (!part) return {};
  const auto [begin, end] = *part;
  Legs legs(tool);
  if (!area.holds_xy(from)) legs.come_back(area.nearest(line.at(begin)));
  // Above the top and below the bottom only X and Y move (F, J): the path bends at the points where the line crosses
  // these heights.
  std::vector<double> bends;
  for (const double height : {0.0, -area.depth}) {
    const double bend = same(from.h, to.h) ? 0 : (height - from.h) / (to.h - from.h);
    if (bend > begin && bend < end) bends.push_back(bend);
  }
  std::sort(bends.begin(), bends.end());
  bends.push_back(end);
  for (const double bend : bends) legs.go(area.nearest(line.at(bend)), Leg::Kind::path);
  return legs.take();
}

}  // namespace axisgate::rml1::simulator
