// Settings that jobs and people leave in a mill and that no command can undo, because a mill never reports its
// settings.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/jobs/job.h"

namespace axisgate::jobs {

class SetupLeft {
 public:
  // Takes over the job that was begun last in the daemon's earlier runs, whatever its state is now.
  void inherit(const Job& last) { last_ = {.number = last.number, .name = last.name, .leaves = last.leaves}; }
  void inherit_z0_count(std::uint64_t z0_count) { z0_count_ = z0_count; }

  // Notes that the job begins. Its settings replace those of the job before.
  void job_begins(const Job& job) { inherit(job); }
  // Notes that a person sets Z0 by hand, so that the Z0 of the last job no longer counts.
  void surface_set_by_hand() { last_.leaves.surface = false; }
  // Notes that Z0 is sent to the mill once more. Returns the new z0_count().
  std::uint64_t count_surface() { return ++z0_count_; }

  // Returns the settings as texts for the person who confirms the next job: "job 7 (part.rml) sets Z0".
  std::vector<std::string> texts() const { return left_by(last_); }
  // Number of times that Z0 was sent, by hand or by a job. Z0 set at the panel is not counted, because the daemon
  // cannot detect it.
  std::uint64_t z0_count() const { return z0_count_; }

 private:
  Job last_;  // job that was begun last; only its number, its name and its leaves are set
  std::uint64_t z0_count_ = 0;
};

}  // namespace axisgate::jobs
