#include "device/shrc203/motion/standstill.h"

#include <algorithm>
#include <cstdlib>

#include "device/shrc203/limits.h"
#include "device/shrc203/state/motions.h"

namespace axisgate::shrc203 {

Task<bool> Standstill::wait(LiveMotionPtr live) {
  int ready = 0;
  Positions last;
  while (ready < 2 && !live->life.line_lost()) {
    const auto read = co_await reader_.read_positions(Lane::motion, live->context.who);
    bool busy = !read.has_value();
    for (const int axis : live->motion.axes.list()) busy = busy || store_.state().axis(axis).busy.value_or(true);
    const Positions here = places_of(*live, store_.state());
    ready = busy ? 0 : here == last ? ready + 1 : 1;
    last = here;
    if (ready >= 2) break;
    auto pause = tasks_.pause(kReadyPoll);
    co_await pause;
  }
  co_return !live->life.line_lost();
}

Task<bool> Standstill::wait_until(LiveMotionPtr live, TimePoint limit) {
  while (tasks_.now() < limit && !live->life.stop_asked() && !live->life.line_lost()) {
    auto changed = live->changed.wait_until(limit);
    co_await changed;
  }
  co_return !live->life.stop_asked() && !live->life.line_lost();
}

bool Standstill::is_at(AxisSet axes, const Place& place, std::int64_t slack) const {
  return std::ranges::all_of(axes.list(), [&](int axis) {
    const auto position = store_.state().axis(axis).position_pulses;
    return position && std::abs(*position - place[static_cast<std::size_t>(axis - 1)]) <= slack;
  });
}

}  // namespace axisgate::shrc203
