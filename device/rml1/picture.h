// Three views of what a job drives, ready to be written as SVG or PNG.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "device/rml1/check.h"

namespace axisgate::rml1 {

// Colours: 0 is travel, the others are cutting, from shallow to deep.
inline constexpr int kShades = 9;
extern const std::array<const char*, kShades> kShadeColours;  // "#rrggbb"

// Collects the moves while a job is checked: 28 bytes each, as many as there are.
class Strokes : public MoveListener {
 public:
  struct Stroke {
    std::array<float, 3> from, to;  // steps
    bool cuts;
  };

  void moved(const Move& move) override;

  const std::vector<Stroke>& all() const { return all_; }
  double lowest() const { return lowest_; }      // steps; 0 or below
  const Reach& feeds() const { return feeds_; }  // mm/s, of what cuts on its way along or down
  int shade(const Stroke& stroke) const;

 private:
  void add(const Point& from, const Point& to, bool cuts);

  std::vector<Stroke> all_;
  double lowest_ = 0;
  Reach feeds_;
};

// Lengths in pixels, y downward.
struct Picture {
  struct View {
    int across, up;  // which of x, y, z
    double x, y;     // where the work origin lies
    double scale;    // pixels a step
  };
  struct Rectangle {
    enum class Kind { work_area, stock, swatch } kind;
    double x, y, width, height;
    int shade = 0;  // of a swatch
  };
  struct Label {
    double x, y;
    std::string text;
    bool heading = false;
  };

  double width = 0, height = 0;
  std::array<View, 3> views{};
  std::vector<Rectangle> rectangles;
  std::vector<Label> labels;
  const Strokes* strokes = nullptr;
};

// `strokes` outlives it.
Picture make_picture(const std::string& title, const Check& check, const Profile& profile, std::optional<Stock> stock,
                     bool origin_known, const Strokes& strokes);

std::string to_svg(const Picture& picture);
// False when the file cannot be written.
bool write_png(const Picture& picture, const std::string& file);

}  // namespace axisgate::rml1
