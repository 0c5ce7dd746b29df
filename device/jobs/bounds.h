// Ranges of values; a range is empty until it takes its first value.
#pragma once

#include <algorithm>
#include <string>

#include "device/jobs/point.h"

namespace axisgate::jobs {

struct Reach {
  bool any = false;
  double lowest = 0, highest = 0;

  void take(double value) {
    lowest = any ? std::min(lowest, value) : value;
    highest = any ? std::max(highest, value) : value;
    any = true;
  }
  double size() const { return highest - lowest; }
};

std::string to_string(const Reach& reach);  // "6500", "400 to 1137"

struct Bounds {
  Reach x, y, z;

  void take(const Point& p) {
    x.take(p.x);
    y.take(p.y);
    z.take(p.z);
  }
};

}  // namespace axisgate::jobs
