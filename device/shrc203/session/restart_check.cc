#include "device/shrc203/session/restart_check.h"

#include <cstddef>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"
#include "device/shrc203/session/answers.h"
#include "device/stage/own_questions.h"

namespace axisgate::shrc203 {

namespace {

// Reports whether `check` is true for the index of any of these axes.
template <class Check>
bool any_index(AxisSet axes, Check check) {
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    if (axes.has(axis) && check(static_cast<std::size_t>(axis - 1))) return true;
  }
  return false;
}

}  // namespace

bool RestartCheck::anywhere_but_zero() const {
  const Positions now = store_.positions();
  return any_index(store_.controllable(), [&](std::size_t axis) { return now[axis].value_or(0) != 0; });
}

bool RestartCheck::still_at(const Positions& before) const {
  const Positions now = store_.positions();
  return any_index(store_.controllable(),
                   [&](std::size_t axis) { return now[axis].value_or(0) != 0 && now[axis] == before[axis]; });
}

Task<bool> RestartCheck::read_positions(std::uint64_t connection) {
  for (int attempt = 0; attempt < kHandshakeTries; ++attempt) {
    const auto read = co_await reader_.read_positions(Lane::question, kGateway, true);
    if (connection != store_.connection()) co_return false;
    if (read) co_return true;
  }
  co_return false;
}

// Decides by the positions. After a restart every command counter shows 0 until something moves, and nothing is moved
// before the decision. One damaged byte turns a 0 into another number, so a position that was not known before must be
// read twice. If all counters showed 0 before, positions prove nothing, and the controller counts as restarted. That
// would be a false alarm on every slow host if only a reply was late; in this case an unchanged resolution is enough.
Task<void> RestartCheck::run(std::uint64_t connection) {
  const Positions before = store_.positions();
  const bool all_at_zero =
      !any_index(store_.controllable(), [&](std::size_t axis) { return before[axis] != std::int64_t{0}; });
  const bool read = co_await read_positions(connection);
  if (connection != store_.connection()) co_return;
  bool same = read && (still_at(before) || (anywhere_but_zero() && !guarded(Guard::restart_read_twice)));
  if (read && !same && anywhere_but_zero()) {
    const bool read_again = co_await read_positions(connection);
    if (connection != store_.connection()) co_return;
    same = read_again && anywhere_but_zero();
  } else if (read && !same && all_at_zero && line_.restart_only_possible()) {
    const auto scale = co_await dialogue_.ask(Dialogue::Question::pulse_length, Lane::question, kGateway, true);
    if (connection != store_.connection()) co_return;
    same = is_data(scale) && scale.reply->text == store_.reported_scales();
  }
  if (same) {
    line_.confirm_no_restart(tasks_.now());
  } else {
    line_.disconnect("the controller seems to have restarted", tasks_.now());
  }
}

}  // namespace axisgate::shrc203
