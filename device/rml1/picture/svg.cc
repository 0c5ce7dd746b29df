// Writes pictures as SVG. Coordinates are whole steps, which the view scales, so numbers stay short.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "device/rml1/picture/picture.h"
#include "device/rml1/picture/relief.h"

namespace axisgate::rml1 {
namespace {

std::string in_base64(const std::string& bytes) {
  static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      group = group << 8 | (at + i < bytes.size() ? static_cast<unsigned char>(bytes[at + i]) : 0U);
    }
    for (unsigned i = 0; i < 4; ++i) text += at + i > bytes.size() ? '=' : kDigits[group >> (18 - 6 * i) & 63U];
  }
  return text;
}

struct Path {
  std::string text;
  std::string holes;  // holes in the view from above
  long x = 0, y = 0;  // end of the path up to now
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

std::string_view class_of(Picture::Rectangle::Kind kind) {
  switch (kind) {
    case Picture::Rectangle::Kind::work_area:
      return "area";
    case Picture::Rectangle::Kind::stock:
      return "stock";
    case Picture::Rectangle::Kind::frame:
      return "frame";
    case Picture::Rectangle::Kind::swatch:
      break;
  }
  return "swatch";
}

void add_rectangle(std::string& svg, const Picture::Rectangle& one) {
  const bool swatch = one.kind == Picture::Rectangle::Kind::swatch;
  svg += fmt::format("<rect class=\"{}\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"{}/>\n",
                     class_of(one.kind), one.x, one.y, one.width, one.height,
                     swatch ? fmt::format(" fill=\"{}\"", kShadeColours[static_cast<std::size_t>(one.shade)]) : "");
}

// A line without length and with round ends is a dot.
void add_hole(Path& path, const Strokes::Stroke& stroke) {
  path.holes += fmt::format("M{} {}h0", std::lround(stroke.to[0]), std::lround(stroke.to[1]));
}

// Returns the paths of one part.
std::array<Path, kShades> paths_of(const Picture& picture, const Picture::View& view, std::size_t part) {
  std::array<Path, kShades> paths;
  const auto at = [&view](const std::array<float, 3>& point, int axis) {
    const auto stretch = static_cast<float>(axis == 2 ? view.stretch : 1);
    return std::lround(point[static_cast<std::size_t>(axis)] * stretch);
  };
  const auto& strokes = picture.strokes->all();
  for (std::size_t index = 0; index < strokes.size(); ++index) {
    const Strokes::Stroke& stroke = strokes[index];
    if (stroke.part != part || is_in_relief(picture, view, stroke)) continue;
    Path& path = paths[static_cast<std::size_t>(picture.shades->of(stroke))];
    path.line(at(stroke.from, view.across), at(stroke.from, view.up), at(stroke.to, view.across),
              at(stroke.to, view.up));
    if (view.from_above() && picture.strokes->is_hole(index)) add_hole(path, stroke);
  }
  return paths;
}

// Returns the attributes in which a path differs from the others of its view. `width`: of the tool, in steps; 0:
// hairlines.
std::string style_of(std::size_t shade, double pixel, double width) {
  if (shade == kTravel) {
    return fmt::format("class=\"travel\" stroke-width=\"{:.6g}\" stroke-dasharray=\"{:.6g} {:.6g}\"", 0.6 * pixel,
                       3 * pixel, 2 * pixel);
  }
  const std::string wide =
      width > 0 && shade != kLeftOut ? fmt::format(" stroke-width=\"{:.6g}\" stroke-linecap=\"round\"", width) : "";
  if (shade == kPerhapsDone) {
    return "class=\"perhaps\"" + (wide.empty() ? fmt::format(" stroke-width=\"{:.6g}\"", 2 * pixel) : wide);
  }
  if (shade == kDone) return "class=\"done\"" + wide;
  if (shade != kLeftOut) return "class=\"cut\"" + wide;
  return fmt::format("class=\"left-out\" stroke-dasharray=\"{:.6g} {:.6g}\"", 2 * pixel, 2 * pixel);
}

void add_strokes(std::string& svg, const Picture& picture, const Picture::View& view, std::size_t part) {
  // Line widths are computed, because not every viewer supports strokes that are not scaled.
  const double pixel = 1 / view.scale;
  const double width = drawn_width(picture, view, part) * pixel;
  const std::array<Path, kShades> paths = paths_of(picture, view, part);
  for (std::size_t shade = 0; shade < paths.size(); ++shade) {
    if (!paths[shade].holes.empty()) {
      svg += fmt::format("<path class=\"hole\" stroke-width=\"{:.6g}\" stroke=\"{}\" d=\"{}\"/>\n", 5 * pixel,
                         kShadeColours[shade], paths[shade].holes);
    }
    if (!paths[shade].begun) continue;
    svg += fmt::format("<path {} stroke=\"{}\" d=\"", style_of(shade, pixel, width), kShadeColours[shade]);
    svg += paths[shade].text;
    svg += "\"/>\n";
  }
}

void add_relief(std::string& svg, const Picture& picture, const Picture::View& view) {
  svg += fmt::format(
      "<image class=\"relief\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" "
      "preserveAspectRatio=\"none\" href=\"data:image/png;base64,{}\"/>\n",
      view.frame.x, view.frame.y, view.frame.width, view.frame.height,
      in_base64(png_of(Relief(*picture.strokes, *picture.shades, picture.diameters, view))));
}

void add_all_strokes(std::string& svg, const Picture& picture, const Picture::View& view) {
  svg += fmt::format(
      "<g class=\"view\" transform=\"matrix({0:.6g} 0 0 {1:.6g} {2:.2f} {3:.2f})\" stroke-width=\"{4:.6g}\">\n",
      view.scale, -view.scale, view.x, view.y, 1 / view.scale);
  for (std::size_t part = 0; part < picture.strokes->parts(); ++part) add_strokes(svg, picture, view, part);
  svg += "</g>\n";
}

void add_view(std::string& svg, const Picture& picture, std::size_t index) {
  const Picture::View& view = picture.views[index];
  svg += fmt::format("<clipPath id=\"view{}\">", index);
  add_rectangle(svg, view.frame);
  svg += fmt::format("</clipPath>\n<g clip-path=\"url(#view{})\">\n", index);
  for (const Picture::Rectangle& one : view.boxes) add_rectangle(svg, one);
  if (picture.relief && view.from_above()) add_relief(svg, picture, view);
  add_all_strokes(svg, picture, view);
  svg += fmt::format("<path class=\"origin\" d=\"M{0:.2f} {1:.2f}m-6 0h12m-6-6v12\"/>\n</g>\n", view.x, view.y);
  add_rectangle(svg, view.frame);
}

std::string_view anchor_of(Picture::Anchor anchor) {
  switch (anchor) {
    case Picture::Anchor::middle:
      return " text-anchor=\"middle\"";
    case Picture::Anchor::end:
      return " text-anchor=\"end\"";
    case Picture::Anchor::start:
      break;
  }
  return "";
}

void add_label(std::string& svg, const Picture::Label& label) {
  svg += fmt::format("<text{}{} x=\"{:.2f}\" y=\"{:.2f}\">{}</text>\n", label.heading ? " class=\"heading\"" : "",
                     anchor_of(label.anchor), label.x, label.y, escaped(label.text));
}

void add_scales(std::string& svg, const std::vector<Picture::Line>& lines) {
  svg += "<path class=\"scale\" d=\"";
  for (const Picture::Line& line : lines) {
    svg += fmt::format("M{:.2f} {:.2f}L{:.2f} {:.2f}", line.from_x, line.from_y, line.to_x, line.to_y);
  }
  svg += "\"/>\n";
}

}  // namespace

std::string to_svg(const Picture& picture) {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\">\n"
      "<style>rect.page{{fill:#fff}}.view "
      "path{{fill:none;stroke-linejoin:round}}.hole{{stroke-linecap:round}}.area{{fill:none;stroke:#555;"
      "stroke-dasharray:6 4}}.stock{{fill:#e8d8b8;fill-opacity:.5;stroke:#a08040}}.frame{{fill:none;stroke:#8c98a4}}"
      ".origin{{fill:none;stroke:#0060c0;stroke-width:1.5}}.scale{{fill:none;stroke:#555}}"
      "text{{font:12px sans-serif;fill:#222}}text.heading{{font-size:18px;font-weight:bold}}"
      "</style>\n<rect class=\"page\" width=\"100%\" height=\"100%\"/>\n",
      picture.width, picture.height);
  for (const Picture::Rectangle& one : picture.rectangles) add_rectangle(svg, one);
  for (std::size_t index = 0; index < picture.views.size(); ++index) add_view(svg, picture, index);
  add_scales(svg, picture.lines);
  for (const Picture::Label& label : picture.labels) add_label(svg, label);
  return svg + "</svg>\n";
}

}  // namespace axisgate::rml1
