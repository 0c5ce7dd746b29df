// Depth of each place of the workpiece on a grid, to find the depth that one pass cuts. Without the map a slot that is
// cut in five passes would look as if one pass had cut it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <unordered_map>

#include "device/jobs/point.h"

namespace axisgate::rml1 {

// Assumes a block of material whose surface is Z0, and a flat tool. Not thread safe.
class HeightMap {
 public:
  // `diameter`: of the tool, in steps. `longest`: length in steps; of a longer path only the end is sampled.
  HeightMap(double diameter, double longest);

  struct Taken {
    double depth = 0;   // steps: greatest depth along the tool's centre
    double volume = 0;  // cubic steps
  };
  // Cuts along a straight path at or below the surface.
  Taken cut(const jobs::Point& from, const jobs::Point& to);
  // Starts another visit of each place: later cuts count as new passes.
  void change_tool() { path_ += kVisit; }
  // Reports whether a part of the job was not measured.
  bool full() const { return full_; }

 private:
  struct Cell {
    float before = 0, now = 0;  // height in steps, before this visit of the tool and after it
    std::uint32_t visited = 0;  // position on the tool's path at its last visit; 0: never visited
  };
  static constexpr int kRadius = 2;  // radius of the tool, in cells, without the cell in the middle
  // Length of path, in cells, within which a place belongs to the same visit: the tool's diameter.
  static constexpr std::uint32_t kVisit = 2 * kRadius + 1;
  static constexpr int kSide = 32;  // side of a tile, in cells
  using Tile = std::array<Cell, static_cast<std::size_t>(kSide) * kSide>;
  // Maximum number of tiles, of 12 KiB each. With a tool of 2 mm they cover more than any machine here; places beyond
  // are not measured.
  static constexpr std::size_t kTiles = 2048;

  Cell* cell(std::int64_t x, std::int64_t y);
  void sample(const jobs::Point& p, Taken& taken);

  double size_;     // size of a cell, in steps
  double longest_;  // in cells
  // Length of path up to now, in cells; begins so high that a cell that was never visited counts as visited long ago.
  double path_ = 2 * kVisit;
  std::unordered_map<std::uint64_t, std::unique_ptr<Tile>> tiles_;
  std::uint64_t last_key_ = 0;
  Tile* last_ = nullptr;
  bool full_ = false;
};

}  // namespace axisgate::rml1
