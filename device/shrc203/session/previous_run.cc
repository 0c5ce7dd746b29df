#include "device/shrc203/session/previous_run.h"

#include <algorithm>

#include "device/core/guard.h"

namespace axisgate::shrc203 {
namespace {

// Reports whether the text is a command. Only ?:CMD is answered by one (manual 4., 6. and 40)).
bool names_a_command(std::string_view text) {
  return text.find(':') != std::string_view::npos || text.starts_with('*') || text == "G";
}

}  // namespace

// Reports whether the line was sent by the previous run, or is a stop that this run wrote when the port opened.
bool PreviousRun::is_ours(std::string_view line_before) const {
  return line_before.starts_with("L:") ||
         std::ranges::find(unfinished_->last_lines, line_before) != unfinished_->last_lines.end();
}

void PreviousRun::heard(std::string_view text) {
  if (!unfinished_ || !store_.left_moving().empty()) return;
  const auto identity = parse_identity(text);
  const bool same_unit = identity && identity->serial_number == unfinished_->serial_number;
  if (is_ours(text) || (same_unit && !names_another_)) return take_over();
  names_another_ = names_another_ || names_a_command(text);
}

void PreviousRun::identified(const Identity& identity, const std::optional<std::string>& line_before) {
  if (!unfinished_) return;
  const bool same_unit = identity.serial_number == unfinished_->serial_number;
  if (same_unit && !store_.left_moving().empty()) return;  // heard() has taken it over
  if (same_unit && (!line_before || is_ours(*line_before))) return take_over();
  store_.note_left_moving({});
  store_.emit(UnfinishedJudged{UnfinishedJudged::What::not_ours, unfinished_->moving, unfinished_->motions});
  unfinished_.reset();
}

void PreviousRun::take_over() {
  const AxisSet moving = unfinished_->moving;
  const bool finishes = store_.profile().at_exit == AtExit::finish;
  const AxisSet stopped = finishes ? unfinished_->jogged : moving;
  store_.note_left_moving(moving);
  if (!stopped.empty()) {
    store_.emit(UnfinishedJudged{UnfinishedJudged::What::stopped, stopped, unfinished_->motions});
    if (guarded(Guard::orphans_stopped)) {
      stops_.stop(stopped, {.who = "the gateway (it had ended during a motion)"});
    }
  }
  if (stopped != moving) {
    store_.emit(UnfinishedJudged{UnfinishedJudged::What::finishes, moving - stopped, unfinished_->motions});
  }
}

void PreviousRun::all_stationary() {
  if (store_.left_moving().empty()) return;
  store_.emit(UnfinishedJudged{UnfinishedJudged::What::stationary, store_.left_moving(), unfinished_->motions});
  store_.note_left_moving({});
  unfinished_.reset();
}

}  // namespace axisgate::shrc203
