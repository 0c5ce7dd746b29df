// Coordinates are whole steps, and the view scales them: numbers stay short.
#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "device/rml1/picture.h"

namespace axisgate::rml1 {
namespace {

struct Path {
  std::string text;
  long x = 0, y = 0;  // where it has come to
  bool begun = false;

  void number(char before, long value) {
    char digits[24];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    text += before;
    text.append(digits, end);
  }
  void line(long from_x, long from_y, long to_x, long to_y) {
    if (from_x == to_x && from_y == to_y) return;
    if (!begun || from_x != x || from_y != y) {
      number('M', from_x);
      number(' ', from_y);
    }
    number('l', to_x - from_x);
    number(' ', to_y - from_y);
    begun = true;
    x = to_x;
    y = to_y;
  }
};

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<' || c == '>' || c == '&' || c == '"') {
      safe += fmt::format("&#{};", static_cast<int>(c));
    } else {
      safe += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    }
  }
  return safe;
}

void add_view(std::string& svg, const Picture& picture, const Picture::View& view) {
  std::array<Path, kShades> paths;
  const auto across = static_cast<std::size_t>(view.across), up = static_cast<std::size_t>(view.up);
  for (const Strokes::Stroke& stroke : picture.strokes->all()) {
    paths[static_cast<std::size_t>(picture.strokes->shade(stroke))].line(
        std::lround(stroke.from[across]), std::lround(stroke.from[up]), std::lround(stroke.to[across]),
        std::lround(stroke.to[up]));
  }
  // Not every reader knows strokes that are not scaled.
  const double pixel = 1 / view.scale;
  svg += fmt::format(
      "<g class=\"view\" transform=\"matrix({0:.6g} 0 0 {1:.6g} {2:.2f} {3:.2f})\" stroke-width=\"{4:.6g}\">\n",
      view.scale, -view.scale, view.x, view.y, pixel);
  for (std::size_t shade = 0; shade < paths.size(); ++shade) {
    if (!paths[shade].begun) continue;
    svg += shade == 0 ? fmt::format("<path class=\"travel\" stroke-width=\"{:.6g}\" stroke-dasharray=\"{:.6g} {:.6g}\"",
                                    0.6 * pixel, 3 * pixel, 2 * pixel)
                      : "<path class=\"cut\"";
    svg += fmt::format(" stroke=\"{}\" d=\"", kShadeColours[shade]);
    svg += paths[shade].text;
    svg += "\"/>\n";
  }
  svg += "</g>\n";
  svg += fmt::format("<path class=\"origin\" d=\"M{0:.2f} {1:.2f}m-6 0h12m-6-6v12\"/>\n", view.x, view.y);
}

std::string_view class_of(Picture::Rectangle::Kind kind) {
  switch (kind) {
    case Picture::Rectangle::Kind::work_area:
      return "area";
    case Picture::Rectangle::Kind::stock:
      return "stock";
    case Picture::Rectangle::Kind::swatch:
      break;
  }
  return "swatch";
}

}  // namespace

std::string to_svg(const Picture& picture) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\">\n"
      "<style>rect.page{{fill:#fff}}.view path{{fill:none;stroke-linejoin:round}}.area{{fill:none;stroke:#555;"
      "stroke-dasharray:6 4}}.stock{{fill:#e8d8b8;fill-opacity:.5;stroke:#a08040}}.origin{{fill:none;stroke:#0060c0;"
      "stroke-width:1.5}}text{{font:12px sans-serif;fill:#222}}text.heading{{font-size:18px;font-weight:bold}}"
      "</style>\n<rect class=\"page\" width=\"100%\" height=\"100%\"/>\n",
      picture.width, picture.height);
  for (const Picture::Rectangle& one : picture.rectangles) {
    const bool swatch = one.kind == Picture::Rectangle::Kind::swatch;
    svg += fmt::format("<rect class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"{}/>\n",
                       class_of(one.kind), one.x, one.y, one.width, one.height,
                       swatch ? fmt::format(" fill=\"{}\"", kShadeColours[static_cast<std::size_t>(one.shade)]) : "");
  }
  for (const Picture::View& view : picture.views) add_view(svg, picture, view);
  for (const Picture::Label& label : picture.labels) {
    svg += fmt::format("<text{} x=\"{:.2f}\" y=\"{:.2f}\">{}</text>\n", label.heading ? " class=\"heading\"" : "",
                       label.x, label.y, escaped(label.text));
  }
  return svg + "</svg>\n";
}

}  // namespace axisgate::rml1
