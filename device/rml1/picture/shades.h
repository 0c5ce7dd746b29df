// Colours of strokes: travel, cuts from shallow to deep in the tint of their part, and strokes already done.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "device/rml1/picture/strokes.h"

namespace axisgate::rml1 {

// Shades in the order of drawing. kLeftOut: left out by clipping. Cuts have kDepths shades, from kShallowest on.
inline constexpr int kDone = 0, kTravel = 1, kLeftOut = 2, kPerhapsDone = 3, kShallowest = 4, kDepths = 8;
// Parts alternate between two tints, each with all depths.
inline constexpr int kTints = 2;
inline constexpr int kShades = kShallowest + kTints * kDepths;
extern const std::array<const char*, kShades> kShadeColours;  // "#rrggbb"

// Shades of a job. If it has few depths, each depth has its own shade; otherwise each shade is one of kDepths equal
// ranges between the shallowest and the deepest cut.
class Shades {
 public:
  Shades(const Strokes& strokes, double step_mm);

  int of(const Strokes::Stroke& stroke) const;
  // Returns the shade of a cut of that part. `depth`: steps, at most that of the deepest cut.
  int of_cut(double depth, std::size_t part) const;
  // Reports whether the cuts have so many depths that each shade is a range of depths, as in a relief.
  bool are_ranges() const { return ranges_; }

  struct Entry {
    int shade;
    std::string text;  // "travel", "0.10 mm deep", "to 0.50 mm deep"
  };
  // Returns entries for the shades that occur.
  std::vector<Entry> legend() const;

 private:
  // A Level joins depths that the legend could not distinguish: it shows hundredths of a millimetre.
  struct Level {
    long hundredths;  // greatest depth below Z0, in hundredths of a mm
    int depth;        // from 0, below kDepths
  };

  long hundredths(double steps) const;
  void set_levels(const Strokes& strokes);
  void add_depths(std::vector<Entry>& entries, int tint) const;

  double step_mm_;
  std::size_t parts_;
  bool ranges_ = false;
  std::vector<Level> levels_;  // ordered from shallow to deep
  std::array<bool, kShades> used_{};
};

}  // namespace axisgate::rml1
