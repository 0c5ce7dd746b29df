// Surface that the cuts of a job leave, seen from above.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "device/rml1/picture/picture.h"

namespace axisgate::rml1 {

// A picture of the surface with light from the upper left. Flat tools are assumed.
class Relief {
 public:
  // `view`: the view from above. `diameters`: diameter of the tool of each part, in steps.
  Relief(const Strokes& strokes, const Shades& shades, const std::vector<double>& diameters, const Picture::View& view);

  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }
  // Pixels row by row from above; 0xffrrggbb, or 0 if nothing is cut there.
  const std::vector<std::uint32_t>& pixels() const { return pixels_; }

 private:
  struct Cell {
    float height = 0;  // steps; 0: nothing is cut
    std::uint8_t part = 0;
  };

  void cut(const Strokes::Stroke& stroke, double radius);
  void lower(double x, double y, double radius, float height, std::uint8_t part);
  float height_at(std::size_t x, std::size_t y) const { return cells_[y * width_ + x].height; }
  double light_at(std::size_t x, std::size_t y) const;

  const Picture::View& view_;
  double cells_a_pixel_ = 0;
  double scale_ = 0;  // cells a step
  std::size_t width_ = 0, height_ = 0;
  std::vector<Cell> cells_;
  std::vector<std::uint32_t> pixels_;
};

// Returns the picture as the bytes of a PNG file.
std::string png_of(const Relief& relief);

}  // namespace axisgate::rml1
