#include "device/shrc203/session/restart_check.h"

#include <algorithm>

#include "device/shrc203/limits.h"
#include "device/shrc203/session/answers.h"
#include "device/stage/own_questions.h"

namespace axisgate::shrc203 {

bool RestartCheck::anywhere_else() const {
  return std::ranges::any_of(store_.state().axes, [](const AxisState& axis) {
    return axis.controllable && axis.position_pulses.value_or(0) != 0;
  });
}

// After a restart every command counter shows 0 until something moves, and nothing is moved before this has been
// decided. Where all showed 0 before, nothing tells, and what is not known to be the same counts as another. Where only
// an answer was late, that would be a false alarm on every slow host: from 0 to 0 places are the same, if pulses are.
Task<void> RestartCheck::run(std::uint64_t connection) {
  const bool at_origin = std::ranges::all_of(
      store_.state().axes, [](const AxisState& axis) { return !axis.controllable || axis.position_pulses == 0; });
  Result<void> read;
  for (int attempt = 0; attempt < kHandshakeTries; ++attempt) {
    read = co_await reader_.read_positions(Lane::question, kGateway, true);
    if (connection != store_.connection()) co_return;
    if (read) break;
  }
  bool same = read && anywhere_else();
  if (read && !same && at_origin && line_.restart_only_possible()) {
    const auto scale = co_await dialogue_.ask(Dialogue::Question::pulse_length, Lane::question, kGateway, true);
    if (connection != store_.connection()) co_return;
    same = is_data(scale) && scale.reply->text == store_.scales_told();
  }
  if (same) {
    line_.still_the_same(tasks_.now());
  } else {
    line_.give_up("the controller seems to have restarted", tasks_.now());
  }
}

}  // namespace axisgate::shrc203
