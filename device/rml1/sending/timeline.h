// The steps of a job, in the order of its bytes, and how long each may take.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// A move, a dwell or a spin-up.
struct Step {
  std::uint64_t end = 0;          // bytes of the job that had to come before
  float least_s = 0, most_s = 0;  // the range that people see (move_time.h)
  float slowest_s = 0;            // by the slowest mill that the profile has: for what runs on
  float mm = 0;                   // of a move
  double slowest_until_s = 0;     // the sum up to the end of this one
  bool turning = false;           // the spindle, from its beginning on
};

class Timeline {
 public:
  // The job was checked: errors in it are passed over, as by a mill. `origin`: as of the check.
  Timeline(std::string_view job, const Profile& profile, std::optional<jobs::Origin> origin);

  const std::vector<Step>& steps() const { return steps_; }
  double slowest_s() const { return slowest_s_; }
  // Returns the time of the steps that end with so many bytes, or before.
  double slowest_until(std::uint64_t end) const;
  double slowest_after(std::uint64_t executed) const { return slowest_s_ - slowest_until(executed); }
  // Reports whether the spindle turns at the end.
  bool turns_at_end() const { return turns_at_end_; }

 private:
  std::vector<Step> steps_;
  double slowest_s_ = 0;
  bool turns_at_end_ = false;
};

}  // namespace axisgate::rml1
