#include "device/shot/line/flood.h"

#include <algorithm>

namespace axisgate::shot {

void Flood::received(std::size_t bytes, TimePoint now) {
  if (now >= window_ + kWindow) {
    window_ = now;
    unclaimed_ = 0;
  }
  unclaimed_ += static_cast<std::int64_t>(bytes);
}

void Flood::belonged(std::size_t bytes) {
  unclaimed_ = std::max<std::int64_t>(0, unclaimed_ - static_cast<std::int64_t>(bytes));
}

}  // namespace axisgate::shot
