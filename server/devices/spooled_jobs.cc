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

std::string facts_of(const rml1::Job& job) {
  Json parts = Json::array();
  for (const rml1::JobPart& part : job.parts) parts.push_back({{"tool", part.tool}, {"end", part.end}});
  return Json{{"profile", job.setup.profile},
              {"origin", job.setup.origin},
              {"parts", parts},
              {"part", job.part},
              {"least_s", job.least_s},
              {"most_s", job.most_s},
              {"leaves",
               {{"surface", job.leaves.surface},
                {"revolutions", job.leaves.revolutions},
                {"rotation", job.leaves.rotation},
                {"tool", job.leaves.tool}}}}
      .dump();
}

rml1::Job job_of(const spool::Job& spooled) {
  const Json facts = facts_in(spooled);
  const Json leaves = facts.value("leaves", Json::object());
  rml1::Job job{.number = spooled.id,
                .name = spooled.name,
                .owner = spooled.who,
                .setup = {spooled.sha256, facts.value("profile", ""), facts.value("origin", ""), ""},
                .bytes = static_cast<std::uint64_t>(spooled.bytes),
                .least_s = facts.value("least_s", 0.0),
                .most_s = facts.value("most_s", 0.0),
                .leaves = {leaves.value("surface", false), leaves.value("revolutions", false),
                           leaves.value("rotation", false), leaves.value("tool", false)}};
  for (const Json& part : facts.value("parts", Json::array())) {
    job.parts.push_back({part.value("tool", ""), part.value("end", std::uint64_t{0})});
  }
  if (const auto part = facts.value("part", std::size_t{0}); part < job.parts.size()) go_to_part(job, part);
  if (job.part > 0) job.state = rml1::JobState::tool_change;
  return job;
}

std::vector<rml1::Job> unended_jobs(const spool::Spool& spool, const std::string& device) {
  std::vector<rml1::Job> jobs;
  for (const spool::Job& spooled : spool.list(device)) {
    if (!spooled.ended) jobs.push_back(job_of(spooled));
  }
  return jobs;
}

rml1::Job as_it_was_left(rml1::Job job, const LastJob& last) {
  if (last.part < job.parts.size()) go_to_part(job, last.part);
  switch (last.state) {
    case rml1::JobState::fed:
      job.state = rml1::JobState::fed;
      break;
    case rml1::JobState::tool_change:
    case rml1::JobState::confirmed:  // its next part
      job.state = rml1::JobState::tool_change;
      break;
    default:
      job.state = rml1::JobState::paused_unknown;
      job.written = rml1::WrittenRange{part_begin(job), std::min(last.through, job.bytes)};
  }
  return job;
}

void keep_part(spool::Spool& spool, const std::string& device, const rml1::Job& job) {
  const auto kept = spool.set_facts(device, job.number, facts_of(job));
  if (!kept) spdlog::warn("{}", explain(kept.error()));
}

std::optional<rml1::Job> spooled_job(const spool::Spool& spool, const std::string& device, rml1::JobNumber job) {
  const auto jobs = spool.list(device);
  const auto found = std::ranges::find(jobs, job, &spool::Job::id);
  return found == jobs.end() ? std::nullopt : std::optional(job_of(*found));
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
                                                              const MillConfig& config, rml1::JobNumber number,
                                                              std::size_t part) {
  std::optional<rml1::Job> job = spooled_job(spool, device, number);
  if (!job) return fail(Reason::not_found, fmt::format("there is no job {}", number));
  if (part < job->parts.size()) go_to_part(*job, part);
  const Result<std::string> bytes = spool.read(device, number);
  if (!bytes) return tl::unexpected(bytes.error());
  const auto named = std::ranges::find(config.origins, job->setup.origin, &NamedOrigin::name);
  const auto origin = named == config.origins.end() ? std::nullopt : std::optional(origin_of(*named, config.profile));
  const std::uint64_t begin = part_begin(*job);
  const std::string_view body = std::string_view(*bytes).substr(begin, part_end(*job) - begin);
  return std::make_shared<const rml1::PreparedJob>(body, job->setup.digest, config.profile, origin, config.sending,
                                                   begin);
}

}  // namespace axisgate::server
