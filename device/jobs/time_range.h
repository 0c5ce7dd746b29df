// A duration that is known only as a range, because a machine that is sent jobs never reports its speed.
#pragma once

#include "device/core/time.h"

namespace axisgate::jobs {

struct TimeRange {
  Duration least{}, most{};

  friend bool operator==(const TimeRange&, const TimeRange&) = default;
  TimeRange& operator+=(const TimeRange& other) {
    least += other.least;
    most += other.most;
    return *this;
  }
};

}  // namespace axisgate::jobs
