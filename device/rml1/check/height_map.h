// How deep each place of the workpiece has been cut, on a grid, to find what one pass takes. Without it a slot that is
// cut in five passes looks like one.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>

#include "device/rml1/machine/point.h"

namespace axisgate::rml1 {

// A block of material whose surface is Z0, and a flat tool. Not thread safe.
class HeightMap {
 public:
  // Both in steps: the tool's diameter; the length of a path beyond which only its end is looked at.
  HeightMap(double diameter, double longest);

  struct Taken {
    double depth = 0;   // steps: at most, along the tool's centre
    double volume = 0;  // cubic steps
  };
  // A straight path at or below the surface.
  Taken cut(const Point& from, const Point& to);
  // Starts another visit of each place: later cuts count as new passes.
  void change_tool() { path_ += kVisit; }
  // Whether something was not measured.
  bool full() const { return full_; }

 private:
  struct Cell {
    float before = 0, now = 0;  // height in steps, before this visit of the tool, and after it
    std::uint32_t visited = 0;  // where on its path the tool came here last; 0: never
  };
  static constexpr int kRadius = 2;  // of the tool, in cells beside the one in the middle
  // So far along its path, in cells, a place belongs to the same visit: the tool's diameter.
  static constexpr std::uint32_t kVisit = 2 * kRadius + 1;
  static constexpr int kSide = 32;  // of a tile, in cells
  using Tile = std::array<Cell, static_cast<std::size_t>(kSide) * kSide>;
  // 12 KiB each. With a tool of 2 mm they cover more than any machine here; what lies beyond is not measured.
  static constexpr std::size_t kTiles = 2048;

  Cell* cell(std::int64_t x, std::int64_t y);
  void sample(const Point& p, Taken& taken);

  double size_;               // of a cell, in steps
  double longest_;            // in cells
  double path_ = 2 * kVisit;  // so far, in cells: a cell that was never visited is far behind
  std::unordered_map<std::uint64_t, std::unique_ptr<Tile>> tiles_;
  std::uint64_t last_key_ = 0;
  Tile* last_ = nullptr;
  bool full_ = false;
};

}  // namespace axisgate::rml1
