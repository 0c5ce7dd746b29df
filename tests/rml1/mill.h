// Mill for tests: a parser before a machine, with all effects of a job as text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/rml1/machine/machine.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// Returns a mill of 605 x 605 x 60.5 mm with steps of 0.01 mm, top 0, Z1 -100, Z2 at the top.
Profile test_profile();

struct Played {
  std::vector<std::string> commands;  // "PD 100 100 0 1", "!ZE X1 Y2": command with its executed parameters
  std::vector<Diagnostic> diagnostics;
  std::vector<Move> moves;
  std::vector<std::string> waits;      // "spin up 2", "dwell 0.5", "turn 3"
  std::vector<jobs::Point> commanded;  // end of each commanded path
  jobs::Point final;
  Box box;
};

// Plays a job. `cuts` are the places at which its bytes are divided into pieces.
Played play(const std::string& job, const Profile& profile, std::optional<jobs::Origin> origin = {},
            std::span<const Row> more_rows = {}, const std::vector<std::size_t>& cuts = {});

// Returns the sum of one of the times of all steps.
double sum_of(const Timeline& timeline, float Step::*time);

}  // namespace axisgate::rml1
