// Position of the tool, in steps.
#pragma once

#include <cmath>

namespace axisgate::jobs {

struct Point {
  double x = 0, y = 0, z = 0;

  friend bool operator==(const Point&, const Point&) = default;
  friend Point operator+(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend Point operator-(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend Point operator*(const Point& a, double factor) { return {a.x * factor, a.y * factor, a.z * factor}; }
};

// Returns `p` if it is at or below the surface. Otherwise returns the point at which the straight path from `p` to
// `other` reaches the surface; `other` must then be at or below it.
inline Point sunk(const Point& p, const Point& other) {
  return p.z <= 0 ? p : p + (other - p) * (p.z / (p.z - other.z));
}

inline double length(const Point& p) { return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z); }

}  // namespace axisgate::jobs
