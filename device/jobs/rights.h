// The right to use a mill, which is leased as a whole: the requests of the mill's controller to the Permission.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/jobs/job.h"
#include "device/use/permission.h"
#include "device/use/request_context.h"

namespace axisgate::jobs {

// Not thread safe.
class Rights {
 public:
  // The permission must outlive this object.
  explicit Rights(use::Permission& permission) : permission_(permission) {}

  // Fails as Permission::authorize() does. `job`: the job to run; 0: no job.
  Result<void> authorize(const use::RequestContext& by, JobNumber job, TimePoint now);
  // Reports that the job occupies the mill until job_ends().
  void job_begins(const Job& job, const use::RequestContext& by, TimePoint now);
  void job_ends(JobNumber job, TimePoint now) { permission_.end(job, now); }
  // Reports a stop of the mill. Other callers whose job it ends, or whose lease it affects, must then rearm.
  void stop_asked(const use::RequestContext& by, TimePoint now);
  // Calls `abort` for each stop that is due because a caller has lost the right to the mill. `who`: the person or
  // caller on whose behalf the mill is stopped.
  void advance(const std::function<void(std::string_view who)>& abort, TimePoint now);
  std::optional<TimePoint> next_deadline() const { return permission_.next_deadline(); }

 private:
  use::Permission& permission_;
};

}  // namespace axisgate::jobs
