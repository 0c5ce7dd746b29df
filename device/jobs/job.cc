#include "device/jobs/job.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>

#include "device/core/transitions.h"

namespace axisgate::jobs {
namespace {

constexpr std::array<std::string_view, kJobStates> kJobStateNames = {
    "QUEUED",         "CONFIRMED", "RUNNING",     "FED",    "DONE",   "ABORTED",
    "PAUSED_UNKNOWN", "CANCELLED", "TOOL_CHANGE", "PAUSED", "EXPIRED"};
constexpr std::array<std::string_view, kJobEvents> kJobEventNames = {
    "confirm", "void",    "void, later part", "void, rest", "start", "raised", "choose rest", "part fed",
    "fed",     "aborted", "abort unsure",     "lost",       "done",  "cancel", "expire"};

}  // namespace

std::string_view name(JobState state) { return kJobStateNames.at(static_cast<std::size_t>(state)); }

std::string_view name(JobEvent event) { return kJobEventNames.at(static_cast<std::size_t>(event)); }

std::optional<JobState> job_state_named(std::string_view name) {
  const auto found = std::ranges::find(kJobStateNames, name);
  return found == kJobStateNames.end() ? std::nullopt
                                       : std::optional(static_cast<JobState>(found - kJobStateNames.begin()));
}

bool is_end(JobState state) {
  return state == JobState::done || state == JobState::aborted || state == JobState::cancelled ||
         state == JobState::expired;
}

std::optional<JobState> next(JobState state, JobEvent event) {
  using enum JobState;
  using Change = Transition<JobState, JobEvent>;
  static constexpr std::array kTable = {
      Change{queued, JobEvent::confirm, confirmed},
      Change{queued, JobEvent::cancel, cancelled},
      Change{queued, JobEvent::expire, expired},
      Change{confirmed, JobEvent::confirm, confirmed},
      Change{confirmed, JobEvent::make_void, queued},
      Change{confirmed, JobEvent::make_void_later, tool_change},
      Change{confirmed, JobEvent::make_void_rest, paused},
      Change{confirmed, JobEvent::start, running},
      Change{confirmed, JobEvent::cancel, cancelled},
      Change{running, JobEvent::part_fed, tool_change},
      Change{running, JobEvent::fed, fed},
      Change{running, JobEvent::raised, paused},
      Change{running, JobEvent::aborted, aborted},
      Change{running, JobEvent::abort_unsure, paused_unknown},
      Change{running, JobEvent::lost, paused_unknown},
      Change{fed, JobEvent::done, done},
      Change{paused_unknown, JobEvent::choose_rest, paused},
      Change{paused_unknown, JobEvent::cancel, cancelled},
      Change{paused, JobEvent::confirm, confirmed},
      Change{paused, JobEvent::choose_rest, paused},
      Change{paused, JobEvent::cancel, cancelled},
      Change{tool_change, JobEvent::confirm, confirmed},
      Change{tool_change, JobEvent::cancel, cancelled},
  };
  return next_in(kTable, state, event);
}

bool is_before(const Job& one, const Job& other) {
  const auto place = [](const Job& job) { return std::tuple(job.state == JobState::queued, job.rank, job.number); };
  return place(one) < place(other);
}

std::uint64_t part_begin(const Job& job) { return job.part == 0 ? 0 : job.parts[job.part - 1].end; }

std::uint64_t part_end(const Job& job) { return job.parts.empty() ? job.bytes : job.parts[job.part].end; }

bool is_last_part(const Job& job) { return job.part + 1 >= job.parts.size(); }

std::uint64_t next_byte(const Job& job) { return part_begin(job) + (job.setup.from ? job.setup.from->offset : 0); }

void go_to_part(Job& job, std::size_t part) {
  job.part = part;
  job.setup.tool = job.parts[part].tool;
  job.setup.from.reset();
  job.written.reset();
}

bool is_waiting(const Job& job) {
  return job.state == JobState::queued || job.state == JobState::confirmed || job.state == JobState::tool_change ||
         job.state == JobState::paused;
}

bool waits_to_begin(const Job& job) {
  return job.state == JobState::queued || (job.state == JobState::confirmed && void_event(job) == JobEvent::make_void);
}

// A rest that was begun and paused or lost has Job::written.
bool is_fresh_rest(const Job& job) { return job.setup.from && !job.written; }

JobEvent void_event(const Job& job) {
  if (is_fresh_rest(job)) return JobEvent::make_void;
  if (job.setup.from) return JobEvent::make_void_rest;
  return job.part == 0 ? JobEvent::make_void : JobEvent::make_void_later;
}

std::vector<std::string> left_by(const Job& job) {
  std::vector<std::string> texts;
  const auto add = [&](std::string_view what) {
    texts.push_back(fmt::format("job {} ({}) {}", job.number, job.name, what));
  };
  if (job.leaves.surface) add("sets Z0");
  if (job.leaves.revolutions) add("sets the spindle speed (!RC)");
  if (job.leaves.rotation) add("turns the rotary axis");
  if (job.leaves.tool) add("has J, which may change the tool");
  return texts;
}

TimeRange takes_later(const Job& job) {
  TimeRange all;
  for (std::size_t part = job.part + 1; part < job.parts.size(); ++part) all += job.parts[part].takes;
  return all;
}

TimeRange takes(const Job& job) {
  TimeRange all = takes_later(job);
  if (!job.parts.empty()) all += job.parts[job.part].takes;
  return all;
}

std::optional<RunOn> run_on(const Job& job) {
  const bool planned = !job.parts.empty() && job.parts[job.part].run_on.at_most > 0;
  return planned ? std::optional(job.parts[job.part].run_on) : std::nullopt;
}

void set_plan(Job& job, const TimeRange& takes, const RunOn& run_on) {
  if (job.parts.empty()) return;
  job.parts[job.part].takes = takes;
  job.parts[job.part].run_on = run_on;
}

std::string executed_text(const Job& job) {
  const auto text = [](const Place& place) { return fmt::format("line {}, column {}", place.line, place.column); };
  const auto& [least, most] = job.executed.value();
  const std::string part = job.parts.size() < 2 ? "" : fmt::format(" of part {}", job.part + 1);
  if (least == most) return fmt::format("by the mill's profile what was executed{} ends at {}", part, text(least));
  return fmt::format("by the mill's profile what was executed{} ends between {} and {}", part, text(least), text(most));
}

std::string text_of(const Job& job) { return fmt::format("job {} ({}, by {})", job.number, job.name, job.owner); }

}  // namespace axisgate::jobs
