#include "device/rml1/picture/relief.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace axisgate::rml1 {
namespace {

constexpr double kFinest = 2;      // cells a pixel
constexpr double kWork = 400e6;    // maximum number of cells touched, for all cuts together
constexpr double kDarkest = 0.35;  // fraction of a colour's light
constexpr double kSteepest = 2;    // a wall is not darker than a slope like this
constexpr double kLightAcross = -1 / std::numbers::sqrt2 / 1.2, kLightUp = 1 / std::numbers::sqrt2 / 1.2;

double radius_of(const Strokes::Stroke& stroke, const std::vector<double>& diameters, double scale) {
  return std::max(0.5, diameters[stroke.part] * scale / 2);
}

// Returns the distance between two discs of the tool. On a level path, discs farther apart leave hardly any gap; on a
// slope they would leave stairs.
double apart(const Strokes::Stroke& stroke, double radius) {
  return stroke.from[2] == stroke.to[2] ? std::max(0.5, radius / 2) : 1;
}

// Returns the total number of cells of all discs, at one cell a pixel.
double work_of(const Strokes& strokes, const std::vector<double>& diameters, double scale) {
  double cells = 0;
  for (const Strokes::Stroke& stroke : strokes.all()) {
    if (stroke.kind != Strokes::Kind::cut) continue;
    const double radius = radius_of(stroke, diameters, scale);
    cells += std::numbers::pi * radius * radius * (stroke.length() * scale / apart(stroke, radius) + 1);
  }
  return cells;
}

// Returns a colour under light. Flat ground keeps its colour; a slope towards the light is paler, a slope away from it
// is darker.
std::uint32_t lit(const char* colour, double light) {
  unsigned value = 0;
  (void)std::from_chars(colour + 1, colour + 7, value, 16);
  const auto channel = [&](unsigned shift) {
    const double plain = value >> shift & 255;
    const double shown =
        light <= 1 ? plain * std::max(kDarkest, light) : plain + (255 - plain) * std::min(1.0, light - 1);
    return static_cast<std::uint32_t>(std::lround(shown)) << shift;
  };
  return 0xff000000U | channel(16) | channel(8) | channel(0);
}

}  // namespace

Relief::Relief(const Strokes& strokes, const Shades& shades, const std::vector<double>& diameters,
               const Picture::View& view)
    : view_(view) {
  const double work = work_of(strokes, diameters, view.scale);
  cells_a_pixel_ = std::clamp(std::cbrt(kWork / std::max(1.0, work)), 0.25, kFinest);
  scale_ = view.scale * cells_a_pixel_;
  width_ = static_cast<std::size_t>(std::ceil(view.frame.width * cells_a_pixel_));
  height_ = static_cast<std::size_t>(std::ceil(view.frame.height * cells_a_pixel_));
  cells_.resize(width_ * height_);
  for (const Strokes::Stroke& stroke : strokes.all()) {
    if (stroke.kind == Strokes::Kind::cut) cut(stroke, radius_of(stroke, diameters, scale_));
  }
  pixels_.resize(cells_.size());
  for (std::size_t y = 0; y < height_; ++y) {
    for (std::size_t x = 0; x < width_; ++x) {
      const Cell& cell = cells_[y * width_ + x];
      if (cell.height >= 0) continue;
      const int shade = shades.of_cut(-cell.height, cell.part);
      pixels_[y * width_ + x] = lit(kShadeColours[static_cast<std::size_t>(shade)], light_at(x, y));
    }
  }
}

void Relief::cut(const Strokes::Stroke& stroke, double radius) {
  const auto across = [&](float steps) { return (view_.x - view_.frame.x) * cells_a_pixel_ + steps * scale_; };
  const auto down = [&](float steps) { return (view_.y - view_.frame.y) * cells_a_pixel_ - steps * scale_; };
  const double from_x = across(stroke.from[0]), from_y = down(stroke.from[1]);
  const double way_x = across(stroke.to[0]) - from_x, way_y = down(stroke.to[1]) - from_y;
  const double samples = std::max(1.0, std::ceil(std::hypot(way_x, way_y) / apart(stroke, radius)));
  for (double sample = 0; sample <= samples; ++sample) {
    const double part = sample / samples;
    const double height = stroke.from[2] + (double{stroke.to[2]} - stroke.from[2]) * part;
    lower(from_x + way_x * part, from_y + way_y * part, radius, static_cast<float>(height), stroke.part);
  }
}

void Relief::lower(double x, double y, double radius, float height, std::uint8_t part) {
  const auto first_row = static_cast<long>(std::max(0.0, std::ceil(y - radius)));
  const long last_row = std::min(static_cast<long>(height_) - 1, static_cast<long>(std::floor(y + radius)));
  for (long row = first_row; row <= last_row; ++row) {
    const double beside = static_cast<double>(row) - y;
    const double half = std::sqrt(std::max(0.0, radius * radius - beside * beside));
    const auto first = static_cast<long>(std::max(0.0, std::ceil(x - half)));
    const long last = std::min(static_cast<long>(width_) - 1, static_cast<long>(std::floor(x + half)));
    for (long column = first; column <= last; ++column) {
      Cell& cell = cells_[static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(column)];
      if (height < cell.height) cell = {height, part};
    }
  }
}

double Relief::light_at(std::size_t x, std::size_t y) const {
  const std::size_t left = x == 0 ? x : x - 1, right = std::min(x + 1, width_ - 1);
  const std::size_t above = y == 0 ? y : y - 1, below = std::min(y + 1, height_ - 1);
  const auto slope = [this](float from, float to) {
    return std::clamp((double{to} - from) * scale_ / 2, -kSteepest, kSteepest);
  };
  const double across = slope(height_at(left, y), height_at(right, y));
  const double up = slope(height_at(x, below), height_at(x, above));
  return (1 - across * kLightAcross - up * kLightUp) / std::sqrt(1 + across * across + up * up);
}

}  // namespace axisgate::rml1
