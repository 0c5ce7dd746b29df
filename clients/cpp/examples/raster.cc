// Measures at the points of a raster, under a lease, and prints a picture of what was measured.
#include <axisgate/axisgate.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <string>
#include <vector>

namespace {

constexpr int kColumns = 5, kRows = 4, kStep_um = 50;

// Stands for a camera or a detector.
double measure(const axisgate::MotionResult& at) {
  return std::hypot(*at.position("x").number() * 1000 - 100, *at.position("y").number() - 75);
}

// Rows run forth and back, so that the axes move as little as possible.
std::vector<axisgate::Point> raster() {
  std::vector<axisgate::Point> points;
  for (int row = 0; row < kRows; ++row) {
    for (int i = 0; i < kColumns; ++i) {
      const int column = row % 2 == 0 ? i : kColumns - 1 - i;
      points.push_back({axisgate::um(column * kStep_um), axisgate::um(row * kStep_um)});
    }
  }
  return points;
}

}  // namespace

int main() {
  try {
    axisgate::Stage stage;
    const axisgate::Lease lease =
        stage.lease({.axes = {"x", "y"}, .wait = std::chrono::minutes(1), .purpose = "raster"});
    stage.home_if_needed({"x", "y"});
    std::vector<std::string> picture(kRows, std::string(kColumns, ' '));
    stage.visit(raster(), {"x", "y"}, [&](const axisgate::MotionResult& at) {
      const auto column = static_cast<std::size_t>(std::lround(*at.position("x").number() * 1000 / kStep_um));
      const auto row = static_cast<std::size_t>(std::lround(*at.position("y").number() / kStep_um));
      picture[row][column] = measure(at) < 60 ? '#' : '.';
    });
    for (const std::string& row : picture) std::cout << row << '\n';
  } catch (const axisgate::Error& error) {
    std::cout << error.what() << '\n';
    return 1;
  }
}
