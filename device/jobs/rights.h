// Rights to a mill, which is leased as a whole: the requests of its controller to the keeper of leases.
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

  // Fails as Permission::authorize() does. `job`: the job that is to run; 0: none.
  Result<void> authorize(const use::RequestContext& by, JobNumber job, TimePoint now);
  // The job occupies the mill until it ends.
  void job_begins(const Job& job, const use::RequestContext& by, TimePoint now);
  void job_ends(JobNumber job, TimePoint now) { permission_.end(job, now); }
  // Holds back those whose job a stop ends, until they rearm.
  void stop_asked(const use::RequestContext& by, TimePoint now);
  // Calls `abort` for each lease whose loss ends a job, on behalf of whom it names.
  void advance(const std::function<void(std::string_view who)>& abort, TimePoint now);
  std::optional<TimePoint> next_deadline() const { return permission_.next_deadline(); }

 private:
  use::Permission& permission_;
};

}  // namespace axisgate::jobs
