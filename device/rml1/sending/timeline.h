// Steps of a job, in the order of its bytes, and how long each step may take.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// A Step is a move, a dwell, a spin-up, or a turn of the axis of rotation. Durations are in seconds.
struct Step {
  std::uint64_t end = 0;          // number of bytes of the job that must arrive before the step
  float least_s = 0, most_s = 0;  // range that is displayed to people (move_time.h)
  float slowest_s = 0;            // duration on the slowest mill of the profile, for bounds (move_time.h)
  float mm = 0;                   // length of a move; 0 for other steps
  double slowest_until_s = 0;     // sum of `slowest_s` of all steps up to and including this step
  bool turning = false;           // the spindle turns from the beginning of the step
};

class Timeline {
 public:
  // `job`: checked bytes; commands with errors are ignored, as a mill ignores them. `origin`: the origin of the check.
  Timeline(std::string_view job, const Profile& profile, std::optional<jobs::Origin> origin);

  const std::vector<Step>& steps() const { return steps_; }
  // Returns the sum of Step::slowest_s over all steps.
  double slowest_s() const { return slowest_s_; }
  // Returns the sum of Step::slowest_s over the steps that need no more than the first `end` bytes.
  double slowest_until(std::uint64_t end) const;
  double slowest_after(std::uint64_t executed) const { return slowest_s_ - slowest_until(executed); }
  // Reports whether the spindle turns at the end of the job.
  bool turns_at_end() const { return turns_at_end_; }

 private:
  std::vector<Step> steps_;
  double slowest_s_ = 0;
  bool turns_at_end_ = false;
};

}  // namespace axisgate::rml1
