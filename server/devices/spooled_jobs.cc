#include "server/devices/spooled_jobs.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "server/events/wall_time.h"
#include "server/explain.h"

namespace axisgate::server {
namespace {

using Json = nlohmann::json;

// Of a text that is none of facts_of() an empty object.
Json facts_in(const spool::Job& spooled) {
  Json facts = Json::parse(spooled.facts, nullptr, false);
  return facts.is_object() ? facts : Json::object();
}

}  // namespace

std::string facts_of(const rml1::JobSetup& setup, double least_s, double most_s) {
  return Json{{"profile", setup.profile},
              {"origin", setup.origin},
              {"tool", setup.tool},
              {"least_s", least_s},
              {"most_s", most_s}}
      .dump();
}

rml1::Job job_of(const spool::Job& spooled) {
  const Json facts = facts_in(spooled);
  return {.number = spooled.id,
          .name = spooled.name,
          .owner = spooled.who,
          .setup = {spooled.sha256, facts.value("profile", ""), facts.value("origin", ""), facts.value("tool", "")},
          .bytes = static_cast<std::uint64_t>(spooled.bytes),
          .least_s = facts.value("least_s", 0.0),
          .most_s = facts.value("most_s", 0.0)};
}

std::vector<rml1::Job> unended_jobs(const spool::Spool& spool, const std::string& device) {
  std::vector<rml1::Job> jobs;
  for (const spool::Job& spooled : spool.list(device)) {
    if (!spooled.ended) jobs.push_back(job_of(spooled));
  }
  return jobs;
}

rml1::Job as_it_was_left(rml1::Job job, const LastJob& last) {
  if (last.state == rml1::JobState::fed) {
    job.state = rml1::JobState::fed;
  } else {
    job.state = rml1::JobState::paused_unknown;
    job.written = rml1::WrittenRange{0, std::min(last.through, job.bytes)};
  }
  return job;
}

void end_spooled(spool::Spool& spool, const std::string& device, rml1::JobNumber job) {
  if (const auto ended = spool.end(device, job, calendar_now()); !ended) spdlog::warn("{}", explain(ended.error()));
}

rml1::Origin origin_of(const NamedOrigin& named, const rml1::Profile& profile) {
  const double z0 = named.z ? static_cast<double>(*named.z) : profile.default_z0;
  return {static_cast<double>(named.x) * profile.step_mm, static_cast<double>(named.y) * profile.step_mm,
          std::abs(profile.top - z0) * profile.step_mm};
}

Result<std::shared_ptr<const rml1::PreparedJob>> prepared_job(const spool::Spool& spool, const std::string& device,
                                                              const MillConfig& config, rml1::JobNumber number) {
  const auto jobs = spool.list(device);
  const auto found = std::ranges::find(jobs, number, &spool::Job::id);
  if (found == jobs.end()) return fail(Reason::not_found, fmt::format("there is no job {}", number));
  const Result<std::string> bytes = spool.read(device, number);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto named = std::ranges::find(config.origins, job_of(*found).setup.origin, &NamedOrigin::name);
  const auto origin = named == config.origins.end() ? std::nullopt : std::optional(origin_of(*named, config.profile));
  return std::make_shared<const rml1::PreparedJob>(*bytes, found->sha256, config.profile, origin, config.sending);
}

}  // namespace axisgate::server
