#include "device/rml1/picture/strokes.h"

#include <cmath>
#include <tuple>

namespace axisgate::rml1 {

void Strokes::moved(const Move& move) {
  const Done is_done = done(move.begin);
  if (move.from.z * move.to.z < 0) {
    const jobs::Point surface = move.from.z > 0 ? sunk(move.from, move.to) : sunk(move.to, move.from);
    add(move.from, surface, move.from.z < 0 ? Kind::cut : Kind::travel, is_done);
    add(surface, move.to, move.to.z < 0 ? Kind::cut : Kind::travel, is_done);
  } else {
    add(move.from, move.to, move.cuts() ? Kind::cut : Kind::travel, is_done);
  }
  if (move.cuts() && !move.lifts()) feeds_.take(move.speed);
}

void Strokes::left_out(const jobs::Point& from, const jobs::Point& to) {
  any_left_out_ = true;
  add(from, to, Kind::left_out, Done::no);
}

double Strokes::Stroke::length() const {
  return std::hypot(double{to[0]} - from[0], double{to[1]} - from[1], double{to[2]} - from[2]);
}

bool Strokes::is_hole(std::size_t index) const {
  const auto vertical = [this](std::size_t at) {
    const Stroke& one = all_[at];
    return one.kind == Kind::cut && one.from[0] == one.to[0] && one.from[1] == one.to[1];
  };
  return index + 1 < all_.size() && vertical(index) && vertical(index + 1) && all_[index].to[2] < all_[index].from[2] &&
         all_[index + 1].to[2] > all_[index].to[2];
}

Strokes::Done Strokes::done(const jobs::Place& begin) const {
  const auto is_before = [&begin](const jobs::Place& end) {
    return std::tie(begin.line, begin.column) < std::tie(end.line, end.column);
  };
  if (is_before(executed_.least)) return Done::yes;
  return is_before(executed_.most) ? Done::perhaps : Done::no;
}

void Strokes::add(const jobs::Point& from, const jobs::Point& to, Kind kind, Done done) {
  const auto single = [](const jobs::Point& p) {
    return std::array<float, 3>{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
  };
  all_.push_back({single(from), single(to), kind, done, part_});
}

}  // namespace axisgate::rml1
