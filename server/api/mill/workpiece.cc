#include "server/api/mill/workpiece.h"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "server/devices/spooled_jobs.h"

namespace axisgate::api {
namespace {

std::string stock_text(const std::optional<jobs::Stock>& stock) {
  return stock ? fmt::format("a stock of {:g} x {:g} x {:g} mm", stock->x, stock->y, stock->z) : "no stock";
}

std::string origin_text(std::string_view origin) {
  return origin.empty() ? "the origin of the panel" : fmt::format("the origin {}", origin);
}

// Returns the newest job last.
Result<std::vector<jobs::Job>> chain_to(const server::Mill& mill, jobs::JobNumber newest) {
  std::vector<jobs::Job> jobs;
  // Each job continues an earlier one, so the loop ends.
  for (jobs::JobNumber number = newest; number != 0; number = jobs.front().continues) {
    Result<jobs::Job> job = server::ended_job(mill.spool(), mill.name(), number);
    if (!job) return tl::unexpected(job.error());
    jobs.insert(jobs.begin(), *std::move(job));
  }
  return jobs;
}

}  // namespace

Result<void> check_same_workpiece(const server::Mill& mill, const jobs::Job& ended, std::string_view origin,
                                  const std::optional<jobs::Stock>& stock) {
  const auto differs = [&ended](const std::string& how, std::string hint) {
    return fail(Reason::setup_changed, fmt::format("{} {}", text_of(ended), how), std::move(hint));
  };
  if (ended.state != jobs::JobState::done) {
    return fail(Reason::wrong_job_state, fmt::format("{} is {}", text_of(ended), name(ended.state)),
                "a job continues only one that a person has seen: DONE");
  }
  if (ended.setup.origin != origin) {
    return differs(fmt::format("had {}, and this job has {}", origin_text(ended.setup.origin), origin_text(origin)),
                   "send it with the same origin");
  }
  if (ended.stock != stock) {
    return differs(fmt::format("had {}, and this job has {}", stock_text(ended.stock), stock_text(stock)),
                   "send it with the same stock");
  }
  if (ended.checked_for != server::checked_for(mill.config(), ended.setup.origin)) {
    return differs("was checked for another profile or place of the origin than is configured now",
                   "send the job without the one that it continues");
  }
  if (ended.leaves.surface) {
    return differs("sets Z0 itself, so it is not known from where its heights count",
                   "send the job without the one that it continues");
  }
  return {};
}

Result<std::unique_ptr<jobs::Check>> workpiece_after(const server::Mill& mill, jobs::JobNumber number,
                                                     const jobs::CheckOptions& options) {
  const Result<std::vector<jobs::Job>> jobs = chain_to(mill, number);
  if (!jobs) return tl::unexpected(jobs.error());
  std::unique_ptr<jobs::Check> last;
  for (jobs::Job job : *jobs) {
    const Result<std::string> bytes = mill.spool().read(mill.name(), job.number);
    if (!bytes) return tl::unexpected(bytes.error());
    for (std::size_t part = 0; part < job.parts.size(); ++part) {
      go_to_part(job, part);
      auto next = mill.config().model->make_check(options);
      if (last) next->continues(*last);
      next->feed(std::string_view(*bytes).substr(part_begin(job), part_end(job) - part_begin(job)));
      next->finish();
      last = std::move(next);
    }
  }
  return last;
}

}  // namespace axisgate::api
