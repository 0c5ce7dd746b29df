// Real path of the tool for a straight line that may leave the work area (guideline 5-1).
#pragma once

#include <vector>

namespace axisgate::rml1::simulator {

// Place in steps: X and Y from the machine's home corner; h is the height from the top of Z's travel, 0 or less inside.
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

// Returns the legs from one commanded point to the next. The tool is at `tool`: inside the area if `from` is, otherwise
// where the path left the area. Legs without length are omitted.
std::vector<Leg> route(const WorkArea& area, const Position& from, const Position& to, const Position& tool);

}  // namespace axisgate::rml1::simulator
