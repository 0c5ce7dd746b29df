#include "clients/axisctl/mill/mill_times.h"

#include <google/protobuf/util/time_util.h>

namespace axisgate::axisctl {
namespace {

using google::protobuf::Duration;

TimeRange still_takes(const v1::Job& job, const v1::RunningJob& running) {
  if (running.job() == job.name()) return time_left(running);
  if (waits(job)) return {job.shortest_time(), job.longest_time()};
  const bool is_over = job.state() == v1::JOB_STATE_FED || job.state() == v1::JOB_STATE_PAUSED_UNKNOWN;
  return {Duration(), is_over ? Duration() : job.longest_time()};
}

}  // namespace

bool waits(const v1::Job& job) {
  return job.state() == v1::JOB_STATE_QUEUED || job.state() == v1::JOB_STATE_CONFIRMED ||
         job.state() == v1::JOB_STATE_TOOL_CHANGE || job.state() == v1::JOB_STATE_PAUSED;
}

TimeRange time_left(const v1::RunningJob& running) {
  return {running.shortest_remaining_time(), running.longest_remaining_time()};
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
