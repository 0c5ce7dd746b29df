// Remaining times of a mill's jobs, and the earliest times at which jobs can begin. A mill never replies, so all times
// are ranges.
#pragma once

#include <google/protobuf/duration.pb.h>

#include <optional>
#include <vector>

#include "axisgate/v1/mill.pb.h"

namespace axisgate::axisctl {

struct TimeRange {
  google::protobuf::Duration least, most;
};

// Reports whether the job is queued, confirmed, in a tool change, or paused with the tool up.
bool waits(const v1::Job& job);

// Returns the remaining time of the running job.
TimeRange time_left(const v1::RunningJob& running);

// Returns, for each job in the order of the queue, the time until the mill has finished the earlier jobs, without any
// waiting for people. nullopt if the job does not wait.
std::vector<std::optional<TimeRange>> earliest_beginnings(const v1::Mill& mill);

}  // namespace axisgate::axisctl
