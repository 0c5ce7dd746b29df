// Metrics of a mill: its line, its queue, and the bytes sent to it.
#pragma once

#include <prometheus/counter.h>
#include <prometheus/family.h>
#include <prometheus/gauge.h>
#include <prometheus/registry.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "device/core/time.h"
#include "device/jobs/job.h"
#include "device/jobs/machine.h"

namespace axisgate::server {

// The time series of one mill. Called on the device's strand; `registry` must outlive this object.
class MillMetrics {
 public:
  MillMetrics(prometheus::Registry& registry, const std::string& device);

  void set_link(jobs::MachineLink link) { line_open_.Set(link == jobs::MachineLink::open ? 1 : 0); }
  // Counts a job that has entered another state.
  void count(const jobs::Job& job, TimePoint now);
  // Counts a command of the running job that was written. `through` is the byte offset after the command.
  void count_written(std::uint64_t through);
  void count_abort() { aborts_.Increment(); }
  // Updates the gauges with the state that MillController reports.
  void set_state(const std::vector<jobs::Job>& jobs, const std::optional<jobs::RunningJob>& running);
  void set_pace(const std::optional<jobs::MeasuredPace>& measured);

 private:
  struct Families;
  // Lower and upper bound of a duration in seconds, of bytes, or of a ratio.
  template <class Series>
  struct Bounds {
    Series &least, &most;
  };

  MillMetrics(const Families& families, const std::string& device);

  prometheus::Gauge& line_open_;
  prometheus::Gauge& busy_;
  prometheus::Counter& commands_;
  prometheus::Counter& bytes_;
  prometheus::Counter& aborts_;
  prometheus::Counter& job_seconds_;
  Bounds<prometheus::Counter> estimate_;
  Bounds<prometheus::Gauge> buffer_;
  Bounds<prometheus::Gauge> pace_;
  std::array<prometheus::Gauge*, jobs::kJobStates> queued_{};      // by JobState; null: not a state of a queued job
  std::array<prometheus::Counter*, jobs::kJobStates> outcomes_{};  // by JobState; null: not an outcome
  std::uint64_t written_ = 0;                                      // of the running job
  TimePoint started_{};
};

}  // namespace axisgate::server
