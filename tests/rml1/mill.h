// A mill for tests: a parser before a machine, and all that came of a job as text.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "device/rml1/machine/machine.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// 605 x 605 x 60.5 mm of 0.01 mm, top 0, Z1 -100, Z2 the top, unless a test changes it.
Profile test_profile();

struct Played {
  std::vector<std::string> commands;  // "PD 100 100 0 1", "!ZE X1 Y2": with what was executed of their parameters
  std::vector<Diagnostic> diagnostics;
  std::vector<Move> moves;
  std::vector<std::string> waits;  // "spin up 2", "dwell 0.5", "turn 3"
  std::vector<Point> commanded;    // where each commanded path ends
  Point final;
  Box box;
};

// `cuts` are places at which the job's bytes are given in pieces.
Played play(const std::string& job, const Profile& profile, std::optional<Origin> origin = {},
            std::span<const Row> more_rows = {}, const std::vector<std::size_t>& cuts = {});

// The sum of one of the times of its steps.
double sum_of(const Timeline& timeline, float Step::*time);

}  // namespace axisgate::rml1
