// How long jobs of a mill still take, and when the next ones can begin. All is a range: a mill never answers.
#pragma once

#include <google/protobuf/duration.pb.h>

#include <optional>
#include <vector>

#include "axisgate/v1/mill.pb.h"

namespace axisgate::axisctl {

struct TimeRange {
  google::protobuf::Duration least, most;
};

// Queued, confirmed, in a tool change, or paused with the tool up.
bool waits(const v1::Job& job);

// Returns what is left of the job that runs.
TimeRange time_left(const v1::RunningJob& running);

// For each job of the queue, in its order: after so long the mill is done with those before it, if nobody ever has to
// be waited for. Nothing where the job does not wait.
std::vector<std::optional<TimeRange>> earliest_beginnings(const v1::Mill& mill);

}  // namespace axisgate::axisctl
