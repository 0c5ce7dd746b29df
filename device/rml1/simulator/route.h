// Where the tool really goes when it is sent along a straight line that may leave the work area (guideline 5-1).
#pragma once

#include <vector>

namespace axisgate::rml1::simulator {

// In steps. X and Y from the machine's home corner; h is the height from the top of Z's travel, so 0 or less inside.
struct Position {
  double x = 0, y = 0, h = 0;

  friend bool operator==(const Position&, const Position&) = default;
};

struct WorkArea {
  double x = 0, y = 0, depth = 0;  // steps from the corner, and from the top down

  Position nearest(const Position& position) const;
  bool holds_xy(const Position& position) const;
};

struct Leg {
  enum class Kind { path, vertical, crossing };
  Position to;
  Kind kind = Kind::path;
};

// From a commanded point to the next, with the tool at `tool`: inside the area if the first is, else where the path has
// left it. Legs without length are omitted.
std::vector<Leg> route(const WorkArea& area, const Position& from, const Position& to, const Position& tool);

}  // namespace axisgate::rml1::simulator
