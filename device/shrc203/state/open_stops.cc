#include "device/shrc203/state/open_stops.h"

#include <algorithm>
#include <utility>

#include "device/core/guard.h"

namespace axisgate::shrc203 {

std::vector<StopJobPtr> OpenStops::inherit(const std::vector<Stop>& stops, StopId last) {
  last_ = last;
  for (const Stop& stop : stops) {
    auto job = std::make_shared<StopJob>();
    job->stop = stop;
    job->context.who = stop.callers.empty() ? "" : stop.callers.front();
    for (const int axis : stop.axes.list()) job->report.axes.emplace_back().axis = axis;
    job->report.stop = stop.id;
    jobs_.push_back(job);
    last_ = std::max(last_, stop.id);
  }
  if (!jobs_.empty()) publish(*jobs_.back());
  return jobs_;
}

StopJobPtr OpenStops::open(AxisSet axes, StopKind kind, const RequestContext& context) {
  auto job = std::make_shared<StopJob>();
  job->stop.id = ++last_;
  job->stop.kind = kind;
  job->stop.axes = axes;
  job->stop.serial_number = store_.unit();
  job->stop.asked = tasks_.now();
  job->context = context;
  job->write_at = tasks_.now();
  for (const int axis : axes.list()) job->report.axes.emplace_back().axis = axis;
  job->report.stop = job->stop.id;
  jobs_.push_back(job);
  return job;
}

void OpenStops::note_caller(StopJob& job, const std::string& who) {
  auto& callers = job.stop.callers;
  const bool known = std::ranges::find(callers, who) != callers.end();
  if (known || callers.size() == Stop::kCallersNamed) return;
  callers.push_back(who);
  publish(job);
}

void OpenStops::note_late(StopJob& job) {
  if (!job.open() || std::exchange(job.stop.late, true)) return;
  publish(job);
}

void OpenStops::note_stale(StopJob& job, bool stale) {
  if (std::exchange(job.stop.stale, stale) != stale) publish(job);
}

void OpenStops::change(const StopJobPtr& job, StopEvent event) {
  const StopState before = job->stop.state;
  const auto to = next(before, event);
  if (!to) return violations_.illegal("stop", name(before), name(event));
  job->stop.state = *to;
  if (!job->open()) {
    job->stop.ended = tasks_.now();
    std::erase(jobs_, job);
  }
  if (before != *to) publish(*job);
}

StopJobPtr OpenStops::find(StopId id) const {
  const auto found = std::ranges::find_if(jobs_, [id](const StopJobPtr& job) { return job->stop.id == id; });
  return found == jobs_.end() ? nullptr : *found;
}

StopJobPtr OpenStops::including(AxisSet axes, StopKind kind) const {
  const auto includes = [&](const StopJobPtr& job) {
    if (job->stop.kind == StopKind::emergency) return true;
    return kind == StopKind::stop && job->stop.axes.contains(axes);
  };
  const auto found = std::ranges::find_if(jobs_, includes);
  return found == jobs_.end() ? nullptr : *found;
}

void OpenStops::publish(const StopJob& job) {
  std::vector<Stop> open;
  for (const StopJobPtr& one : jobs_) open.push_back(one->stop);
  store_.note_open_stops(std::move(open));
  store_.emit(StopChanged{job.stop});
  store_.publish();
}

void OpenStops::latch(const std::string& who) {
  if (store_.state().emergency || !guarded(Guard::emergency_latches)) return;
  show_latch(EmergencyLatch{who, tasks_.now()}, who);
}

void OpenStops::inherit(const EmergencyLatch& latch) { show_latch(latch, latch.who); }

void OpenStops::unlatch(const std::string& who) {
  if (store_.state().emergency) show_latch(std::nullopt, who);
}

void OpenStops::show_latch(std::optional<EmergencyLatch> latch, const std::string& who) {
  store_.note_emergency(latch);
  store_.emit(EmergencyLatchChanged{std::move(latch), who});
  store_.publish();
}

}  // namespace axisgate::shrc203
