// The state in which jobs and people leave a mill, as far as no command can undo it: it never says what was set.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/jobs/job.h"

namespace axisgate::jobs {

class SetupLeft {
 public:
  // Takes over the job that was begun last in the runs before, whatever has become of it.
  void inherit(const Job& last) { last_ = {.number = last.number, .name = last.name, .leaves = last.leaves}; }
  void inherit_surfaces(std::uint64_t surfaces) { surfaces_ = surfaces; }

  // Notes that the job begins: what earlier jobs have left no longer counts.
  void job_begins(const Job& job) { inherit(job); }
  // Notes that a person sets Z0 by hand.
  void surface_set_by_hand() { last_.leaves.surface = false; }
  // Counts that Z0 is sent. Returns the new surfaces().
  std::uint64_t count_surface() { return ++surfaces_; }

  // "job 7 (part.rml) sets Z0": texts for the person who confirms the next job.
  std::vector<std::string> texts() const { return left_by(last_); }
  // Number of times that Z0 was sent, by hand or by a job. Z0 set at the panel is not counted: nobody sees it.
  std::uint64_t surfaces() const { return surfaces_; }

 private:
  Job last_;  // its number, its name and what it leaves
  std::uint64_t surfaces_ = 0;
};

}  // namespace axisgate::jobs
