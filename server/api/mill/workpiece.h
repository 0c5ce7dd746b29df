// Workpiece that jobs of a mill have cut, for the check of a job that continues it.
#pragma once

#include <memory>

#include "device/core/problem.h"
#include "device/jobs/check.h"
#include "device/jobs/job.h"
#include "server/devices/mill.h"

namespace axisgate::api {

// Checks that a job of that origin and stock can continue the workpiece of the ended job. Fails with wrong_job_state if
// the ended job is not DONE, and with setup_changed if origin, stock or configuration differ, or if it sets Z0 itself.
Result<void> check_same_workpiece(const server::Mill& mill, const jobs::Job& ended, std::string_view origin,
                                  const std::optional<jobs::Stock>& stock);

// Returns a check that has played the job and all jobs whose workpiece it continued, oldest first. Must not be called
// on a device's strand, because it reads whole jobs. Fails with not_found if the spool no longer has one of the jobs.
Result<std::unique_ptr<jobs::Check>> workpiece_after(const server::Mill& mill, jobs::JobNumber job,
                                                     const jobs::CheckOptions& options);

}  // namespace axisgate::api
