#include "clients/axisctl/mill_times.h"

#include <google/protobuf/util/time_util.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace axisgate::axisctl {
namespace {

using google::protobuf::Duration;
using google::protobuf::util::TimeUtil;

Duration part_left(const Duration& whole, std::int64_t executed, std::int64_t all) {
  if (all <= 0) return whole;
  const double left = static_cast<double>(all - std::clamp<std::int64_t>(executed, 0, all)) / static_cast<double>(all);
  return TimeUtil::MillisecondsToDuration(
      std::llround(static_cast<double>(TimeUtil::DurationToMilliseconds(whole)) * left));
}

// From its next part, or the rest of that, on.
TimeRange parts_left(const v1::Job& job) {
  std::int64_t executed = job.setup().from().byte();
  for (int part = 0; part < std::min(job.part(), job.parts_size()); ++part) executed += job.parts(part).bytes();
  return {part_left(job.shortest(), executed, job.bytes()), part_left(job.longest(), executed, job.bytes())};
}

TimeRange still_takes(const v1::Job& job, const v1::RunningJob& running) {
  if (running.job() == job.name()) return time_left(job, running);
  if (waits(job)) return parts_left(job);
  const bool is_over = job.state() == v1::JOB_STATE_FED || job.state() == v1::JOB_STATE_PAUSED_UNKNOWN;
  return {Duration(), is_over ? Duration() : job.longest()};
}

}  // namespace

bool waits(const v1::Job& job) {
  return job.state() == v1::JOB_STATE_QUEUED || job.state() == v1::JOB_STATE_CONFIRMED ||
         job.state() == v1::JOB_STATE_TOOL_CHANGE || job.state() == v1::JOB_STATE_PAUSED;
}

TimeRange time_left(const v1::Job& job, const v1::RunningJob& running) {
  return {part_left(job.shortest(), running.executed_most(), job.bytes()),
          part_left(job.longest(), running.executed_least(), job.bytes())};
}

std::vector<std::optional<TimeRange>> earliest_beginnings(const v1::Mill& mill) {
  using google::protobuf::operator+=;
  std::vector<std::optional<TimeRange>> beginnings;
  TimeRange before;
  for (const v1::Job& job : mill.jobs()) {
    beginnings.push_back(waits(job) ? std::optional(before) : std::nullopt);
    const TimeRange takes = still_takes(job, mill.running());
    before.least += takes.least;
    before.most += takes.most;
  }
  return beginnings;
}

}  // namespace axisgate::axisctl
