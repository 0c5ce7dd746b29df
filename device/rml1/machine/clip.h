// The work area, and what of a commanded path the tool really drives (guideline 5-1).
#pragma once

#include <functional>

#include "device/rml1/machine/point.h"

namespace axisgate::rml1 {

// In workpiece coordinates. The tool never leaves it.
struct Box {
  Point lowest, highest;

  bool over(const Point& p) const {  // the rectangle of X and Y
    return p.x >= lowest.x && p.x <= highest.x && p.y >= lowest.y && p.y <= highest.y;
  }
  Point held(const Point& p) const;  // the nearest place inside
};

// How a piece of the real path came about: at whose speed it is driven.
enum class Piece {
  commanded,  // as it was commanded
  raise,      // on the way back to where the commanded path comes in
  across,
  descent,
};

using Piecewise = std::function<void(const Point& from, const Point& to)>;
// The pieces of a straight commanded path that lie beyond the sides of the box or below it: the tool does not drive
// them as commanded. Beyond the top nothing is lost.
void find_left_out(const Box& box, const Point& from, const Point& to, const Piecewise& left_out);

class Clipper {
 public:
  using Driven = std::function<void(Piece, const Point& from, const Point& to)>;

  // It begins inside: at the nearest place to `begin`.
  Clipper(const Box& box, const Point& begin) : box_(box), commanded_(box.held(begin)), tool_(commanded_) {}

  const Box& box() const { return box_; }
  const Point& commanded() const { return commanded_; }
  const Point& tool() const { return tool_; }
  bool outside() const { return outside_; }

  // A straight commanded path to there.
  void move_to(const Point& target, const Driven& driven);
  // Whatever was commanded: straight to a place inside, which is then the commanded one.
  void drive_to(const Point& target, const Driven& driven);
  // Another Z0: the same machine place has other coordinates.
  void shift(double z, const Box& box);

 private:
  void follow(const Point& from, const Point& to, const Driven& driven);
  void come_back(const Point& at, const Driven& driven);
  void drive(Piece piece, const Point& to, const Driven& driven);

  Box box_;
  Point commanded_, tool_;
  bool outside_ = false;
};

}  // namespace axisgate::rml1
