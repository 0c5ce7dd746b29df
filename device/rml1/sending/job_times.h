// Duration of a job as it is sent, and its remaining time. Both are ranges, because a mill never reports its speed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "device/core/time.h"
#include "device/jobs/send_settings.h"
#include "device/jobs/time_range.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// Immutable. Times count from the first byte of the job to the end of its last movement.
class JobTimes {
 public:
  // `window`: SendPlan::window.
  JobTimes(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings, std::size_t window);

  jobs::TimeRange whole() const { return left(0, 0); }
  // Returns the remaining time when at least `executed_least` and at most `executed_most` bytes of the job have been
  // executed.
  jobs::TimeRange left(std::uint64_t executed_least, std::uint64_t executed_most) const;

 private:
  // A Moment is the time, in seconds, at which the commands up to the byte `end` have been executed.
  struct Moment {
    std::uint64_t end = 0;
    float least = 0, most = 0;
  };

  void add_paced(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings,
                 std::size_t window);
  void add_full(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings, std::size_t window);
  Moment at(std::uint64_t executed) const;

  std::vector<Moment> moments_;
};

}  // namespace axisgate::rml1
