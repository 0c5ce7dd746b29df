// Which colour a stroke has: travel, cuts from shallow to deep in the tint of their part, and those that are done.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "device/rml1/picture/strokes.h"

namespace axisgate::rml1 {

// In the order of drawing. kLeftOut: by clipping. Cutting has kDepths of them, from kShallowest on.
inline constexpr int kDone = 0, kTravel = 1, kLeftOut = 2, kPerhapsDone = 3, kShallowest = 4, kDepths = 8;
// Parts take turns in two tints, each with all depths.
inline constexpr int kTints = 2;
inline constexpr int kShades = kShallowest + kTints * kDepths;
extern const std::array<const char*, kShades> kShadeColours;  // "#rrggbb"

// One shade for each depth where a job has few; else equal ranges between its shallowest and its deepest cut.
class Shades {
 public:
  Shades(const Strokes& strokes, double step_mm);

  int of(const Strokes::Stroke& stroke) const;
  // Returns the shade of a cut of that part, so many steps deep, and at most as deep as its deepest one.
  int of_cut(double depth, std::size_t part) const;
  // Reports whether the cuts have so many depths that a shade is a range of them, as those of a relief have.
  bool are_ranges() const { return ranges_; }

  struct Entry {
    int shade;
    std::string text;  // "travel", "0.10 mm deep", "to 0.50 mm deep"
  };
  // Of what is there, and nothing else.
  std::vector<Entry> legend() const;

 private:
  // Depths that the legend could not distinguish are one: it shows hundredths of a millimetre.
  struct Level {
    long hundredths;  // mm below Z0, at most
    int depth;        // from 0, below kDepths
  };

  long hundredths(double steps) const;
  void set_levels(const Strokes& strokes);
  void add_depths(std::vector<Entry>& entries, int tint) const;

  double step_mm_;
  std::size_t parts_;
  bool ranges_ = false;
  std::vector<Level> levels_;  // from shallow to deep
  std::array<bool, kShades> used_{};
};

}  // namespace axisgate::rml1
