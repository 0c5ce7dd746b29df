// Computes how long a job takes as it is sent, and how long its rest takes. A mill never says how fast it is, so both
// are ranges.
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

// Immutable. The time begins with the first byte, and ends with the last movement.
class JobTimes {
 public:
  // `window`: SendPlan::window.
  JobTimes(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings, std::size_t window);

  jobs::TimeRange whole() const { return left(0, 0); }
  // Returns the time that is left when so many bytes of the job have been executed, at least and at most.
  jobs::TimeRange left(std::uint64_t executed_least, std::uint64_t executed_most) const;

 private:
  // A command, and when it has been executed: seconds.
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
