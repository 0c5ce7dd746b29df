#include "device/shot/line/reservations.h"

#include <algorithm>

#include "device/shot/limits.h"

namespace axisgate::shot {

bool Reservations::allow(MotionId motion, Duration length, TimePoint now) const {
  return std::ranges::all_of(due_, [&](const auto& entry) {
    const auto& [path, due] = entry;
    return path == motion || now + length <= due || now >= due + kRefillReservedAfterDue;
  });
}

std::optional<TimePoint> Reservations::next_expiry(TimePoint now) const {
  std::optional<TimePoint> next;
  for (const auto& [path, due] : due_) {
    const TimePoint expires = due + kRefillReservedAfterDue;
    if (expires > now && (!next || expires < *next)) next = expires;
  }
  return next;
}

}  // namespace axisgate::shot
