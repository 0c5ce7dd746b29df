#include "device/rml1/mill/job.h"

#include <fmt/format.h>

#include <array>

#include "device/core/transitions.h"

namespace axisgate::rml1 {
namespace {

constexpr std::array<std::string_view, 8> kNames = {"QUEUED", "CONFIRMED", "RUNNING",        "FED",
                                                    "DONE",   "ABORTED",   "PAUSED_UNKNOWN", "CANCELLED"};

}  // namespace

std::string_view name(JobState state) { return kNames.at(static_cast<std::size_t>(state)); }

bool is_end(JobState state) {
  return state == JobState::done || state == JobState::aborted || state == JobState::cancelled;
}

std::optional<JobState> next(JobState state, JobEvent event) {
  using enum JobState;
  using Change = Transition<JobState, JobEvent>;
  static constexpr std::array kTable = {
      Change{queued, JobEvent::confirm, confirmed},
      Change{queued, JobEvent::cancel, cancelled},
      Change{confirmed, JobEvent::confirm, confirmed},
      Change{confirmed, JobEvent::make_void, queued},
      Change{confirmed, JobEvent::start, running},
      Change{confirmed, JobEvent::cancel, cancelled},
      Change{running, JobEvent::fed, fed},
      Change{running, JobEvent::aborted, aborted},
      Change{running, JobEvent::lost, paused_unknown},
      Change{fed, JobEvent::done, done},
      Change{paused_unknown, JobEvent::cancel, cancelled},
  };
  return next_in(kTable, state, event);
}

std::string text_of(const Job& job) { return fmt::format("job {} ({}, by {})", job.number, job.name, job.owner); }

}  // namespace axisgate::rml1
