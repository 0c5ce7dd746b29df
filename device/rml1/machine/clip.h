// Work area, and the part of a commanded path that the tool really drives (guideline 5-1).
#pragma once

#include <functional>

#include "device/jobs/point.h"

namespace axisgate::rml1 {

// A Box is the work area in workpiece coordinates. The tool never leaves it.
struct Box {
  jobs::Point lowest, highest;

  bool over(const jobs::Point& p) const {  // inside in X and Y
    return p.x >= lowest.x && p.x <= highest.x && p.y >= lowest.y && p.y <= highest.y;
  }
  jobs::Point held(const jobs::Point& p) const;  // nearest place inside
};

// Origin of a piece of the real path; decides which speed applies.
enum class Piece {
  commanded,  // part of the commanded path
  raise,      // while returning to the place where the commanded path comes in
  across,
  descent,
};

using Piecewise = std::function<void(const jobs::Point& from, const jobs::Point& to)>;
// Reports the pieces of a straight commanded path that lie beyond the sides of the box or below it; the tool does not
// drive them as commanded. Pieces above the top are not lost.
void find_left_out(const Box& box, const jobs::Point& from, const jobs::Point& to, const Piecewise& left_out);

class Clipper {
 public:
  using Driven = std::function<void(Piece, const jobs::Point& from, const jobs::Point& to)>;

  // The tool begins inside, at the place nearest to `begin`.
  Clipper(const Box& box, const jobs::Point& begin) : box_(box), commanded_(box.held(begin)), tool_(commanded_) {}

  const Box& box() const { return box_; }
  const jobs::Point& commanded() const { return commanded_; }
  const jobs::Point& tool() const { return tool_; }
  bool outside() const { return outside_; }

  // Drives a straight commanded path to `target`.
  void move_to(const jobs::Point& target, const Driven& driven);
  // Drives straight to the place nearest to `target` inside, regardless of the path commanded before; this place then
  // is the commanded one.
  void drive_to(const jobs::Point& target, const Driven& driven);
  // Sets another Z0, which gives the same machine place other coordinates.
  void shift(double z, const Box& box);

 private:
  void follow(const jobs::Point& from, const jobs::Point& to, const Driven& driven);
  void come_back(const jobs::Point& at, const Driven& driven);
  void drive(Piece piece, const jobs::Point& to, const Driven& driven);

  Box box_;
  jobs::Point commanded_, tool_;
  bool outside_ = false;
};

}  // namespace axisgate::rml1
