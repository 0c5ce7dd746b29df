#include "device/shrc203/session/stop_writer.h"

#include <algorithm>
#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {

bool StopWriter::takes_none() const {
  if (!guarded(Guard::stop_off_host)) return false;
  return non_host_.edits() || (!non_host_.away() && store_.panel_is_wrong());
}

std::vector<ExchangeRequest> StopWriter::lines_due(std::string_view heard) {
  const bool opened = heard.empty();
  if (opened) heard_ = false;
  if (const auto identity = parse_identity(heard)) {
    other_unit_ = !store_.is_expected(*identity) && guarded(Guard::stop_not_to_another_unit);
  }
  std::vector<ExchangeRequest> lines;
  if (takes_none() || other_unit_) return lines;
  // On a line that stayed open, OK may be the late reply to the stop itself. The next line, which answers ?:CMD or
  // *IDN?, decides.
  if (heard == "OK" && line_.state().trusted()) return lines;
  const bool first = !opened && !std::exchange(heard_, true);
  const bool written = opened ? guarded(Guard::stop_written_at_open) : first && guarded(Guard::stop_written_when_heard);
  const bool refused = !opened && !first && heard == "NG" && guarded(Guard::stop_one_axis_at_a_time);
  for (const StopJobPtr& job : open_.all()) {
    // The reply to ?:CMD is the stop itself: the controller has received it.
    if (heard == command_for(*job, excited(*job)).line) continue;
    if (written && !job->taken) write_blindly(job, false, lines);
    if (refused && job->named_several) write_blindly(job, true, lines);
  }
  return lines;
}

void StopWriter::write_blindly(const StopJobPtr& job, bool alone, std::vector<ExchangeRequest>& lines) {
  const AxisSet named = excited(*job);
  if (!alone) {
    lines.push_back(request_for(*job, command_for(*job, named)));
  } else {
    for (const int axis : named.list()) lines.push_back(request_for(*job, commands::stop(AxisSet::of(axis))));
  }
  job->named_several = !alone && job->stop.kind == StopKind::stop && named.count() > 1;
  job->taken = false;
  job->write_at = TimePoint::max();
  for (auto& axis : job->report.axes) axis.named = named.has(axis.axis);
  open_.change(job, StopEvent::wrote);
}

void StopWriter::line_answers() {
  for (const StopJobPtr& job : open_.all()) {
    job->named_several = false;
    if (job->write_at == TimePoint::max()) job->write_at = tasks_.now();
  }
}

void StopWriter::line_lost() {
  for (const StopJobPtr& job : open_.all()) {
    job->write_at = TimePoint::max();
    job->taken = job->stationary = false;
    open_.note_stale(*job, false);
    job->stationary_looks = job->kept_looks = 0;
  }
}

Command StopWriter::command_for(const StopJob& job, AxisSet axes) const {
  if (job.stop.kind == StopKind::emergency) return commands::emergency_stop();
  return non_host_.in_program() ? commands::stop_program() : commands::stop(axes);
}

ExchangeRequest StopWriter::request_for(const StopJob& job, Command command) const {
  ExchangeRequest request;
  request.command = std::move(command);
  request.lane = Lane::stop;
  request.caller = job.context.who;
  request.not_after = tasks_.now() + kStopWriteLimit;
  return request;
}

// Returns the axes that the stop names. The known excitation may be out of date: if no motor seems to be on, the stop
// names every axis, and the controller decides.
AxisSet StopWriter::excited(const StopJob& job) const {
  AxisSet named = job.stop.axes;
  for (const int axis : job.stop.axes.list()) {
    const bool off = !store_.state().axis(axis).excited.value_or(true) && guarded(Guard::stop_names_excited_axes);
    if (job.stop.kind != StopKind::emergency && off) named.remove(axis);
  }
  return named.empty() ? job.stop.axes : named;
}

Duration StopWriter::slowing(AxisSet axes) const {
  int longest_ms = 0;
  for (const int axis : axes.list()) {
    longest_ms = std::max(longest_ms, store_.state().axis(axis).acceleration_ms.value_or(1000));
  }
  return std::chrono::milliseconds(longest_ms);
}

Task<void> StopWriter::write(StopJobPtr job) {
  const AxisSet named = excited(*job);
  job->write_at = TimePoint::max();
  auto pending = dialogue_.exchange(request_for(*job, command_for(*job, named)));
  const auto result = co_await pending;
  if (!job->open()) co_return;
  if (result.written) open_.change(job, StopEvent::wrote);
  note_result(*job, named, result);
  if (result.refused() && job->stop.kind == StopKind::stop && named.count() > 1) co_await write_one_at_a_time(job);
}

// Notes the reply in the report. The time of the next repetition depends only on whether the controller received the
// stop.
void StopWriter::note_result(StopJob& job, AxisSet named, const ExchangeResult& result) const {
  const bool received = (result.reply && !result.problem) || result.received.value_or(false);
  const bool in_barrier = result.in_doubt() && result.problem->reason == Reason::outcome_unknown;
  for (auto& axis : job.report.axes) {
    axis.named = named.has(axis.axis);
    if (!axis.named) continue;
    if (result.reply) axis.wire_reply = result.reply->text;
    axis.reply_unreadable = result.in_doubt() && result.problem->reason == Reason::line_fault;
  }
  job.taken = received;
  if (received) {
    job.write_at = tasks_.now() + slowing(job.stop.axes) + kStopRepeatAfterSlowing;
    if (!guarded(Guard::stop_again)) job.write_at = TimePoint::max();
  } else if (!in_barrier && line_.state().port_open() && guarded(Guard::stop_again)) {
    job.write_at = tasks_.now();
  }
}

Task<void> StopWriter::write_one_at_a_time(StopJobPtr job) {
  if (!guarded(Guard::stop_one_axis_at_a_time)) co_return;
  for (auto& axis : job->report.axes) {
    if (!axis.named || !job->open()) continue;
    auto pending = dialogue_.exchange(request_for(*job, commands::stop(AxisSet::of(axis.axis))));
    const auto one = co_await pending;
    axis.wire_reply = one.reply ? one.reply->text : "";
  }
}

}  // namespace axisgate::shrc203
