// Which colour a stroke has: travel, and depths from shallow to deep.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "device/rml1/strokes.h"

namespace axisgate::rml1 {

// In the order of drawing: 0 is travel, then comes what clipping leaves out, and then cutting.
inline constexpr int kLeftOut = 1, kShallowest = 2, kDepths = 8, kShades = kShallowest + kDepths;
extern const std::array<const char*, kShades> kShadeColours;  // "#rrggbb"

// One shade for each depth where a job has few; else equal ranges of depth.
class Shades {
 public:
  Shades(const Strokes& strokes, double step_mm);

  int of(const Strokes::Stroke& stroke) const;

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
    int shade;
    bool used = false;
  };

  long hundredths(double steps) const;
  void set_levels(const Strokes& strokes);
  std::size_t level_of(const Strokes::Stroke& stroke) const;

  double step_mm_;
  bool ranges_ = false;
  std::vector<Level> levels_;  // from shallow to deep
  bool travel_ = false, left_out_ = false;
};

}  // namespace axisgate::rml1
