#include "server/devices/spooled_jobs.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "device/core/explain.h"
#include "server/events/wall_time.h"
#include "server/log.h"
#include "server/spool/sha256.h"

namespace axisgate::server {
namespace {

using Json = nlohmann::json;

// Returns an empty object if the text was not written by facts_of().
Json facts_in(const spool::Job& spooled) {
  Json facts = Json::parse(spooled.facts, nullptr, false);
  return facts.is_object() ? facts : Json::object();
}

std::optional<jobs::Place> place_in(const Json& facts) {
  const Json from = facts.value("from", Json::array());
  return from.size() == 3 ? std::optional(jobs::Place{from[0], from[1], from[2]}) : std::nullopt;
}

Json facts_of(const jobs::Place& place) { return {place.offset, place.line, place.column}; }

std::optional<jobs::WrittenRange> written_in(const Json& facts) {
  const Json written = facts.value("written", Json::array());
  return written.size() == 2 ? std::optional(jobs::WrittenRange{written[0], written[1]}) : std::nullopt;
}

bool are_numbers(const Json& all, std::size_t count) {
  return all.is_array() && all.size() == count && std::ranges::all_of(all, &Json::is_number);
}

std::optional<jobs::PlaceRange> executed_in(const Json& facts) {
  const Json executed = facts.value("executed", Json::array());
  const bool known = executed.size() == 2 && are_numbers(executed[0], 3) && are_numbers(executed[1], 3);
  if (!known) return std::nullopt;
  const auto place = [](const Json& one) { return jobs::Place{one[0], one[1], one[2]}; };
  return jobs::PlaceRange{place(executed[0]), place(executed[1])};
}

// Returns a part without a plan if it was kept without one.
jobs::JobPart part_in(const Json& facts) {
  jobs::JobPart part{facts.value("tool", ""), facts.value("end", std::uint64_t{0})};
  const Json takes = facts.value("takes_ns", Json::array()), run_on = facts.value("run_on", Json::array());
  if (!are_numbers(takes, 2) || !are_numbers(run_on, 4)) return part;
  part.takes = {Duration(takes[0]), Duration(takes[1])};
  part.run_on = {run_on[0], run_on[1], Duration(run_on[2]), run_on[3]};
  return part;
}

Json facts_of(const jobs::JobPart& part) {
  const jobs::RunOn& run_on = part.run_on;
  return {{"tool", part.tool},
          {"end", part.end},
          {"takes_ns", {part.takes.least.count(), part.takes.most.count()}},
          {"run_on", {run_on.at_most, run_on.if_held, run_on.longest.count(), run_on.mm}}};
}

Json facts_of(const jobs::Reach& reach) { return reach.any ? Json{reach.lowest, reach.highest} : Json::array(); }

Json facts_of(const jobs::Bounds& bounds) { return {facts_of(bounds.x), facts_of(bounds.y), facts_of(bounds.z)}; }

jobs::Reach reach_in(const Json& facts) {
  return are_numbers(facts, 2) ? jobs::Reach{true, facts[0], facts[1]} : jobs::Reach();
}

jobs::Bounds bounds_in(const Json& facts) {
  if (!facts.is_array() || facts.size() != 3) return {};
  return {reach_in(facts[0]), reach_in(facts[1]), reach_in(facts[2])};
}

std::vector<std::string> accepted_in(const Json& facts) {
  std::vector<std::string> accepted;
  for (const Json& name : facts) {
    if (name.is_string()) accepted.push_back(name);
  }
  return accepted;
}

Result<std::string> part_bytes(const spool::Spool& spool, const std::string& device, const jobs::Job& job) {
  const std::uint64_t begin = part_begin(job), end = part_end(job);
  return spool.read(device, job.number).map([&](const std::string& all) { return all.substr(begin, end - begin); });
}

std::optional<jobs::Origin> check_origin(const MillConfig& config, const jobs::Job& job) {
  const auto named = std::ranges::find(config.origins, job.setup.origin, &jobs::NamedOrigin::name);
  return named == config.origins.end() ? std::nullopt : std::optional(config.model->place_of(*named));
}

// Returns PAUSED only if the place in the spool is the recorded one. The place may not have reached the spool before
// the daemon ended, or may belong to an earlier rest; the place to continue is then unknown.
jobs::JobState state_as_left(const jobs::Job& job, const LastJob& last) {
  using enum jobs::JobState;
  const bool between = last.state == tool_change || last.state == confirmed;
  if (last.state == fed) return fed;
  if (job.setup.from && next_byte(job) == last.from && (between || last.state == paused)) return paused;
  return between && job.part > 0 ? tool_change : paused_unknown;
}

// Returns the range of bytes of the part within which the executed bytes end. Bytes that the mill was sent and did not
// lose are executed, except those that its buffer may contain.
jobs::WrittenRange executed_of(const MillConfig& config, const jobs::Job& job) {
  if (job.executed) return {job.executed->least.offset, job.executed->most.offset};
  const std::uint64_t begin = part_begin(job);
  const jobs::WrittenRange sent = job.written.value_or(jobs::WrittenRange{next_byte(job), next_byte(job)});
  if (sent.least == sent.most) return {sent.least - begin, sent.most - begin};
  const std::uint64_t unread = config.sending.flow_control ? config.sending.buffer : sent.least;
  return {sent.least - std::min<std::uint64_t>(unread, sent.least - begin) - begin, sent.most - begin};
}

tl::unexpected<Problem> no_line_named(std::string_view body, const MillConfig& config, const jobs::Job& job) {
  const auto text = [&](std::uint64_t byte) {
    const jobs::Place place = jobs::place_of(body, byte);
    return fmt::format("line {}, column {}", place.line, place.column);
  };
  const jobs::WrittenRange executed = executed_of(config, job);
  const bool exact = executed.least == executed.most;
  return fail(Reason::invalid_request,
              fmt::format("no line is named from which {} continues: what the mill has executed of it ends at {}{}",
                          text_of(job), text(executed.least),
                          exact ? "" : fmt::format(", or later, up to {}", text(executed.most))),
              "look at the workpiece, and name a line or a column before what is missing");
}

}  // namespace

std::string facts_of(const jobs::Job& job) {
  Json parts = Json::array();
  for (const jobs::JobPart& part : job.parts) parts.push_back(facts_of(part));
  Json facts{{"profile", job.setup.profile},
             {"origin", job.setup.origin},
             {"parts", parts},
             {"part", job.part},
             {"rank", job.rank},
             {"leaves",
              {{"surface", job.leaves.surface},
               {"revolutions", job.leaves.revolutions},
               {"rotation", job.leaves.rotation},
               {"tool", job.leaves.tool}}}};
  facts["driven_mm"] = facts_of(job.extent.driven);
  facts["cut_mm"] = facts_of(job.extent.cut);
  for (const std::string& warning : job.accepted) facts["accepted"].push_back(warning);
  if (job.stock) facts["stock"] = {job.stock->x, job.stock->y, job.stock->z};
  facts["checked_for"] = job.checked_for;
  facts["planned_for"] = job.planned_for;
  if (job.streaming) facts["streaming"] = *job.streaming == jobs::Streaming::full ? "full" : "paced";
  if (job.setup.from) facts["from"] = facts_of(*job.setup.from);
  if (job.written) facts["written"] = {job.written->least, job.written->most};
  if (job.executed) facts["executed"] = {facts_of(job.executed->least), facts_of(job.executed->most)};
  if (job.continues != 0) facts["continues"] = job.continues;
  facts["z0_count"] = job.z0_count;
  if (is_end(job.state)) facts["ended_as"] = name(job.state);
  return facts.dump();
}

jobs::Job job_of(const spool::Job& spooled) {
  const Json facts = facts_in(spooled);
  const Json leaves = facts.value("leaves", Json::object());
  jobs::Job job{.number = spooled.id,
                .name = spooled.name,
                .owner = spooled.who,
                .setup = {spooled.sha256, facts.value("profile", ""), facts.value("origin", ""), "", {}, {}},
                .bytes = static_cast<std::uint64_t>(spooled.bytes),
                .leaves = {leaves.value("surface", false), leaves.value("revolutions", false),
                           leaves.value("rotation", false), leaves.value("tool", false)},
                .rank = facts.value("rank", std::int64_t{0}),
                .queued_since = to_monotonic(spooled.created)};
  for (const Json& part : facts.value("parts", Json::array())) {
    job.parts.push_back(part_in(part));
  }
  if (const auto part = facts.value("part", std::size_t{0}); part < job.parts.size()) go_to_part(job, part);
  if (const std::string streaming = facts.value("streaming", ""); !streaming.empty()) {
    job.streaming = streaming == "full" ? jobs::Streaming::full : jobs::Streaming::paced;
  }
  job.checked_for = facts.value("checked_for", "");
  job.planned_for = facts.value("planned_for", "");
  job.extent = {bounds_in(facts.value("driven_mm", Json())), bounds_in(facts.value("cut_mm", Json()))};
  job.accepted = accepted_in(facts.value("accepted", Json::array()));
  const Json stock = facts.value("stock", Json::array());
  if (stock.size() == 3 && std::ranges::all_of(stock, &Json::is_number)) {
    job.stock = jobs::Stock{stock[0], stock[1], stock[2]};
  }
  job.continues = facts.value("continues", jobs::JobNumber{0});
  job.z0_count = facts.value("z0_count", std::uint64_t{0});
  job.setup.from = place_in(facts);
  if (job.setup.from) job.written = written_in(facts);
  if (is_fresh_rest(job)) return job;
  if (job.part > 0) job.state = jobs::JobState::tool_change;
  if (job.setup.from) job.state = jobs::JobState::paused;
  return job;
}

std::vector<jobs::Job> unended_jobs(const spool::Spool& spool, const std::string& device) {
  std::vector<jobs::Job> jobs;
  for (const spool::Job& spooled : spool.list(device)) {
    if (!spooled.ended) jobs.push_back(job_of(spooled));
  }
  return jobs;
}

jobs::Job as_it_was_left(jobs::Job job, const LastJob& last) {
  if (last.part != job.part && last.part < job.parts.size()) go_to_part(job, last.part);
  job.state = state_as_left(job, last);
  if (job.state == jobs::JobState::paused_unknown) {
    job.written = jobs::WrittenRange{std::min(last.sent_least, job.bytes), std::min(last.through, job.bytes)};
  }
  return job;
}

void keep_facts(spool::Spool& spool, const std::string& device, const jobs::Job& job) {
  const auto kept = spool.set_facts(device, job.number, facts_of(job));
  if (!kept) log::warn("{}", explain(kept.error()));
}

void end_spooled(spool::Spool& spool, const std::string& device, const jobs::Job& job) {
  const auto ended = spool.end(device, job.number, calendar_now(), facts_of(job));
  if (!ended) log::warn("{}", explain(ended.error()));
}

Result<jobs::Job> ended_job(const spool::Spool& spool, const std::string& device, jobs::JobNumber number) {
  const auto jobs = spool.list(device);
  const auto found = std::ranges::find(jobs, number, &spool::Job::id);
  if (found == jobs.end()) {
    return fail(Reason::not_found, fmt::format("job {} of {} is not kept", number, device),
                "`ListHistory` shows what became of it; send its file again");
  }
  jobs::Job job = job_of(*found);
  const Json facts = facts_in(*found);
  if (!found->ended) {
    return fail(Reason::wrong_job_state, fmt::format("{} has not ended", text_of(job)),
                "`GetMill` shows what can be done with it");
  }
  job.state = jobs::job_state_named(facts.value("ended_as", "")).value_or(jobs::JobState::cancelled);
  job.written = written_in(facts);
  job.executed = executed_in(facts);
  return job;
}

std::string checked_for(const MillConfig& config, const std::string& origin) {
  spool::Sha256 sha256;
  sha256.add(config.model->description());
  const auto named = std::ranges::find(config.origins, origin, &jobs::NamedOrigin::name);
  if (named != config.origins.end()) {
    sha256.add(fmt::format(" {} {} {}", named->x, named->y, named->z ? fmt::to_string(*named->z) : "-"));
  }
  return sha256.hexadecimal();
}

std::string planned_for(const MillConfig& config) {
  const jobs::SendSettings& sending = config.sending;
  return fmt::format("{} {} {} {} {} {} {}", static_cast<int>(sending.streaming), sending.window, sending.slack,
                     sending.slack_as_measured, sending.buffer, sending.converter, sending.baud);
}

Result<std::shared_ptr<const jobs::PreparedJob>> prepared_job(const spool::Spool& spool, const std::string& device,
                                                              const MillConfig& config, const jobs::Job& job,
                                                              const std::optional<jobs::MeasuredPace>& measured) {
  const Result<std::string> body = part_bytes(spool, device, job);
  if (!body) return tl::unexpected(body.error());
  return config.model->prepare({*body, job, check_origin(config, job), config.sending, measured});
}

Result<void> plan_job(spool::Spool& spool, const std::string& device, const MillConfig& config, jobs::Job& job,
                      const std::optional<jobs::MeasuredPace>& measured) {
  jobs::Job at = job;
  for (std::size_t part = job.part; part < job.parts.size(); ++part) {
    if (part != job.part) go_to_part(at, part);
    const auto prepared = prepared_job(spool, device, config, at, measured);
    if (!prepared) return tl::unexpected(prepared.error());
    job.parts[part].takes = (*prepared)->takes();
    job.parts[part].run_on = (*prepared)->run_on();
  }
  job.planned_for = planned_for(config);
  keep_facts(spool, device, job);
  return {};
}

Result<jobs::Place> chosen_rest(const spool::Spool& spool, const std::string& device, const MillConfig& config,
                                const jobs::Job& job, std::uint64_t line, std::uint64_t column) {
  const Result<std::string> body = part_bytes(spool, device, job);
  if (!body) return tl::unexpected(body.error());
  if (line == 0) return no_line_named(*body, config, job);
  return config.model->rest_from({*body, job, check_origin(config, job), config.sending, {}}, line, column);
}

}  // namespace axisgate::server
