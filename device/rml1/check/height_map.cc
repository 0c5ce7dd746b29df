#include "device/rml1/check/height_map.h"

#include <algorithm>
#include <cmath>

namespace axisgate::rml1 {
namespace {

std::uint32_t tile_of(std::int64_t cell) { return static_cast<std::uint32_t>(cell >> 5); }  // a tile has 32 cells

}  // namespace

HeightMap::HeightMap(double diameter, double longest)
    : size_(diameter / (2 * kRadius + 1)), longest_(longest / size_) {}

HeightMap::Taken HeightMap::cut(const jobs::Point& from, const jobs::Point& to) {
  const jobs::Point way = to - from;
  const double plane = std::hypot(way.x, way.y) / size_;
  // A tool that moves straight down begins another pass.
  if (plane == 0) path_ += kVisit;
  Taken taken;
  // Discs at this distance leave no gap between them.
  const double samples = plane > longest_ ? 1 : std::max(1.0, std::ceil(plane / kRadius));
  for (double sample_number = 1; sample_number <= samples; ++sample_number) {
    path_ += plane / samples;
    sample(from + way * (sample_number / samples), taken);
  }
  taken.volume *= size_ * size_;
  return taken;
}

// Lowers a disc of cells, row by row. A row nearly always lies in one tile.
void HeightMap::sample(const jobs::Point& p, Taken& taken) {
  const auto x = static_cast<std::int64_t>(std::floor(p.x / size_));
  const auto y = static_cast<std::int64_t>(std::floor(p.y / size_));
  const auto z = static_cast<float>(p.z);
  const auto here = static_cast<std::uint32_t>(static_cast<std::uint64_t>(path_));
  const auto lower = [&](Cell& one) {
    if (here - one.visited >= kVisit) one.before = one.now;
    one.visited = here;
    if (z >= one.now) return;
    taken.volume += one.now - z;
    one.now = z;
  };
  for (int row = -kRadius; row <= kRadius; ++row) {
    const int half = row == -kRadius || row == kRadius ? kRadius - 1 : kRadius;
    if (tile_of(y - half) == tile_of(y + half)) {
      Cell* const first = cell(x + row, y - half);
      if (first != nullptr) std::for_each_n(first, 2 * half + 1, lower);
      continue;
    }
    for (int column = -half; column <= half; ++column) {
      if (Cell* const one = cell(x + row, y + column)) lower(*one);
    }
  }
  if (const Cell* const centre = cell(x, y)) taken.depth = std::max<double>(taken.depth, centre->before - z);
}

HeightMap::Cell* HeightMap::cell(std::int64_t x, std::int64_t y) {
  const std::uint64_t key = std::uint64_t{tile_of(x)} << 32 | tile_of(y);
  if (last_ == nullptr || key != last_key_) {
    const auto found = tiles_.find(key);
    if (found == tiles_.end() && tiles_.size() == kTiles) {
      full_ = true;
      return nullptr;
    }
    auto& tile = found == tiles_.end() ? tiles_[key] : found->second;
    if (!tile) tile = std::make_unique<Tile>();
    last_ = tile.get();
    last_key_ = key;
  }
  return &(*last_)[static_cast<std::size_t>(x & (kSide - 1)) * kSide + static_cast<std::size_t>(y & (kSide - 1))];
}

}  // namespace axisgate::rml1
