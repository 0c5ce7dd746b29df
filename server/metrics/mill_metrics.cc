#include "server/metrics/mill_metrics.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "server/metrics/families.h"

namespace axisgate::server {
namespace {

using jobs::JobState;

std::size_t index_of(JobState state) { return static_cast<std::size_t>(state); }

prometheus::Labels of_state(const std::string& device, const char* label, JobState state) {
  return {{"device", device}, {label, std::string(jobs::name(state))}};
}

prometheus::Labels of_bound(const std::string& device, const char* bound) {
  return {{"device", device}, {"bound", bound}};
}

}  // namespace

struct MillMetrics::Families {
  explicit Families(prometheus::Registry& registry)
      : line_open(gauge_family(registry, "axisgate_mill_line_open", "1 when the line to the mill is open, else 0.")),
        queued_jobs(gauge_family(registry, "axisgate_mill_queued_jobs",
                                 "Jobs without an end, by state: those that wait, the one that runs, and those that "
                                 "wait for a person's word.")),
        jobs(counter_family(registry, "axisgate_mill_jobs_total",
                            "Jobs by what became of them; one that is FED or PAUSED_UNKNOWN has an end later, too.")),
        commands(counter_family(registry, "axisgate_mill_commands_total",
                                "Commands of jobs that were written; of a list of coordinates that is longer than the "
                                "window, its parts.")),
        bytes(counter_family(registry, "axisgate_mill_written_bytes_total", "Bytes of jobs that were written.")),
        buffer(gauge_family(registry, "axisgate_mill_buffer_bytes",
                            "Bytes of the job that were written and that the mill has not executed, by computation: "
                            "if it is as fast (least) or as slow (most) as its profile allows.")),
        pace(gauge_family(
            registry, "axisgate_mill_pace_ratio",
            "Measured time of the mill by that of the slowest of its profile, at least and at most; 0 until it "
            "was measured.")),
        busy(gauge_family(registry, "axisgate_mill_busy",
                          "1 when the mill has taken nothing of the job that runs for `busy_limit_s`, else 0.")),
        aborts(counter_family(registry, "axisgate_mill_aborts_total", "Aborts requested, also where no job ran.")),
        job_seconds(counter_family(registry, "axisgate_mill_job_seconds_total",
                                   "Time from the start to FED, with pauses, of the jobs that were FED.")),
        estimate(counter_family(registry, "axisgate_mill_job_estimate_seconds_total",
                                "Time that was computed for the same jobs at their start, at least and at most.")) {}

  prometheus::Family<prometheus::Gauge>& line_open;
  prometheus::Family<prometheus::Gauge>& queued_jobs;
  prometheus::Family<prometheus::Counter>& jobs;
  prometheus::Family<prometheus::Counter>& commands;
  prometheus::Family<prometheus::Counter>& bytes;
  prometheus::Family<prometheus::Gauge>& buffer;
  prometheus::Family<prometheus::Gauge>& pace;
  prometheus::Family<prometheus::Gauge>& busy;
  prometheus::Family<prometheus::Counter>& aborts;
  prometheus::Family<prometheus::Counter>& job_seconds;
  prometheus::Family<prometheus::Counter>& estimate;
};

MillMetrics::MillMetrics(prometheus::Registry& registry, const std::string& device)
    : MillMetrics(Families(registry), device) {}

MillMetrics::MillMetrics(const Families& families, const std::string& device)
    : line_open_(families.line_open.Add({{"device", device}})),
      busy_(families.busy.Add({{"device", device}})),
      commands_(families.commands.Add({{"device", device}})),
      bytes_(families.bytes.Add({{"device", device}})),
      aborts_(families.aborts.Add({{"device", device}})),
      job_seconds_(families.job_seconds.Add({{"device", device}})),
      estimate_{families.estimate.Add(of_bound(device, "least")), families.estimate.Add(of_bound(device, "most"))},
      buffer_{families.buffer.Add(of_bound(device, "least")), families.buffer.Add(of_bound(device, "most"))},
      pace_{families.pace.Add(of_bound(device, "least")), families.pace.Add(of_bound(device, "most"))} {
  for (const JobState state : {JobState::queued, JobState::confirmed, JobState::running, JobState::tool_change,
                               JobState::paused, JobState::fed, JobState::paused_unknown}) {
    queued_.at(index_of(state)) = &families.queued_jobs.Add(of_state(device, "state", state));
  }
  for (const JobState state : {JobState::fed, JobState::paused_unknown, JobState::done, JobState::aborted,
                               JobState::cancelled, JobState::expired}) {
    outcomes_.at(index_of(state)) = &families.jobs.Add(of_state(device, "outcome", state));
  }
}

void MillMetrics::count(const jobs::Job& job, TimePoint now) {
  if (auto* const outcome = outcomes_.at(index_of(job.state))) outcome->Increment();
  if (job.state == JobState::running) {
    started_ = now;
    written_ = next_byte(job);
  }
  // The estimate covers only a whole job of one part.
  if (job.state != JobState::fed || job.parts.size() > 1 || job.setup.from) return;
  job_seconds_.Increment(std::chrono::duration<double>(now - started_).count());
  const jobs::TimeRange takes = jobs::takes(job);
  estimate_.least.Increment(std::chrono::duration<double>(takes.least).count());
  estimate_.most.Increment(std::chrono::duration<double>(takes.most).count());
}

// Commands that the gateway adds around a job are not counted.
void MillMetrics::count_written(std::uint64_t through) {
  if (through <= written_) return;
  bytes_.Increment(static_cast<double>(through - written_));
  commands_.Increment();
  written_ = through;
}

void MillMetrics::set_state(const std::vector<jobs::Job>& jobs, const std::optional<jobs::RunningJob>& running) {
  for (std::size_t state = 0; state < jobs::kJobStates; ++state) {
    if (queued_.at(state) == nullptr) continue;
    const auto in_state = [state](const jobs::Job& job) { return index_of(job.state) == state; };
    queued_.at(state)->Set(static_cast<double>(std::ranges::count_if(jobs, in_state)));
  }
  const jobs::SendProgress progress = running ? running->progress : jobs::SendProgress{};
  buffer_.least.Set(static_cast<double>(progress.written - progress.executed_most));
  buffer_.most.Set(static_cast<double>(progress.written - progress.executed_least));
  busy_.Set(running && running->busy ? 1 : 0);
}

void MillMetrics::set_pace(const std::optional<jobs::MeasuredPace>& measured) {
  const auto pace = measured.value_or(jobs::MeasuredPace{});
  pace_.least.Set(pace.least);
  pace_.most.Set(pace.most);
}

}  // namespace axisgate::server
