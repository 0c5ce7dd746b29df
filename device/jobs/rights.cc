#include "device/jobs/rights.h"

#include <fmt/format.h>

namespace axisgate::jobs {
namespace {

use::Use whole_mill(const use::RequestContext& by, JobNumber job) {
  return {by.who, by.lease, use::Scope::whole_device(), job, by.session};
}

}  // namespace

Result<void> Rights::authorize(const use::RequestContext& by, JobNumber job, TimePoint now) {
  return permission_.authorize(whole_mill(by, job), now);
}

void Rights::job_begins(const Job& job, const use::RequestContext& by, TimePoint now) {
  const use::Occupation occupation{fmt::format("{}, started by {}", job.name, by.who),
                                   fmt::format("job {} runs", job.number), "", now + takes(job).most};
  permission_.begin(whole_mill(by, job.number), occupation, now);
}

void Rights::stop_asked(const use::RequestContext& by, TimePoint now) {
  permission_.stop_asked(whole_mill(by, 0), {}, now);
}

void Rights::advance(const std::function<void(std::string_view who)>& abort, TimePoint now) {
  const use::Orders orders = permission_.advance(now);
  for (const use::StopOrder& order : orders.stops) {
    abort(order.who);
    permission_.stopped(order.id, now);
  }
  for (const use::EndedLease& lease : orders.restoring) permission_.settings_restored(lease.token, now);
}

}  // namespace axisgate::jobs
