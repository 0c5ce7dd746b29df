// Three views of the driven path of a job, ready to be written as SVG.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "device/rml1/check/check.h"
#include "device/rml1/picture/shades.h"
#include "device/rml1/picture/strokes.h"

namespace axisgate::rml1 {

// Lengths in pixels, y downward.
struct Picture {
  struct Rectangle {
    enum class Kind { work_area, stock, swatch, frame } kind;
    double x, y, width, height;
    int shade = 0;  // colour of a swatch
  };
  // One view. Its contents end at its frame.
  struct View {
    int across = 0, up = 0;  // axes: 0 is x, 1 is y, 2 is z
    Rectangle frame{};
    double x = 0, y = 0;             // position of the work origin
    double scale = 1;                // pixels a step
    int stretch = 1;                 // factor by which Z is drawn longer
    std::vector<Rectangle> boxes{};  // work area and stock

    bool from_above() const { return across == 0 && up == 1; }
    double scale_across() const { return across == 2 ? scale * stretch : scale; }
    double scale_up() const { return up == 2 ? scale * stretch : scale; }
  };
  struct Line {
    double from_x, from_y, to_x, to_y;
  };
  enum class Anchor { start, middle, end };
  struct Label {
    double x, y;
    std::string text;
    bool heading = false;
    Anchor anchor = Anchor::start;
  };

  double width = 0, height = 0;
  std::array<View, 3> views{};
  std::vector<Rectangle> rectangles;
  std::vector<Line> lines;  // lines of scales
  std::vector<Label> labels;
  const Strokes* strokes = nullptr;
  std::optional<Shades> shades{};
  // Diameter of the tool of each part, in steps; empty: hairlines are drawn.
  std::vector<double> diameters{};
  bool relief = false;  // the view from above shows the surface that the cuts leave, and not the cuts
};

// `parts`: the checks of the job's files, at least one, each with the same stock and origin. `strokes`: strokes of all
// parts, which must outlive the picture.
Picture make_picture(const std::string& title, const std::vector<const Check*>& parts, const Profile& profile,
                     std::optional<jobs::Stock> stock, bool origin_known, const Strokes& strokes);

// Reports whether the view shows the stroke as part of the surface that the cuts leave.
bool is_in_relief(const Picture& picture, const Picture::View& view, const Strokes::Stroke& stroke);
// Returns the width of a part's cuts in that view, in pixels: the tool's width, or 0 for hairlines.
double drawn_width(const Picture& picture, const Picture::View& view, std::size_t part);

std::string to_svg(const Picture& picture);

}  // namespace axisgate::rml1
