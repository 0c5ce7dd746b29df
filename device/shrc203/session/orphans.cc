#include "device/shrc203/session/orphans.h"

#include <algorithm>

#include "device/core/guard.h"

namespace axisgate::shrc203 {

bool Orphans::is_ours(const Identity& identity, const std::optional<std::string>& line_before) const {
  return identity.serial_number == unfinished_->serial_number && line_before &&
         std::ranges::find(unfinished_->last_lines, *line_before) != unfinished_->last_lines.end();
}

void Orphans::identified(const Identity& identity, const std::optional<std::string>& line_before) {
  if (!unfinished_ || !store_.left_moving().empty()) return;
  const AxisSet moving = unfinished_->moving;
  if (!is_ours(identity, line_before)) {
    store_.emit(UnfinishedJudged{UnfinishedJudged::What::not_ours, moving, unfinished_->motions});
    unfinished_.reset();
    return;
  }
  const bool finishes = store_.profile().at_exit == AtExit::finish;
  const AxisSet stopped = finishes ? unfinished_->jogged : moving;
  axes_ = axes_ | stopped;
  store_.note_left_moving(moving);
  if (!stopped.empty()) store_.emit(UnfinishedJudged{UnfinishedJudged::What::stopped, stopped, unfinished_->motions});
  if (stopped != moving) {
    store_.emit(UnfinishedJudged{UnfinishedJudged::What::finishes, moving - stopped, unfinished_->motions});
  }
}

void Orphans::stop() {
  if (axes_.empty() || !guarded(Guard::orphans_stopped)) return;
  stops_.stop(axes_, {.who = "the gateway: a motion ran on while the line or the gateway was away"});
}

void Orphans::all_stationary() {
  axes_ = {};
  if (store_.left_moving().empty()) return;
  store_.emit(UnfinishedJudged{UnfinishedJudged::What::stationary, store_.left_moving(), unfinished_->motions});
  store_.note_left_moving({});
  unfinished_.reset();
}

}  // namespace axisgate::shrc203
