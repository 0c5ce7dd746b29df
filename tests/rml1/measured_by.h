// Pace of the simulated mill, measured from a job with `full` streaming.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "device/rml1/sending/pace_meter.h"
#include "tests/rml1/abort_bench.h"
#include "tests/rml1/trace.h"

namespace axisgate::rml1 {

// Returns the measured pace. `line` is the line as the host sees it; its converter must also be in the settings.
inline std::optional<jobs::MeasuredPace> measured_by(const std::string& job, simulator::MillSetup mill,
                                                     jobs::SendSettings settings, LineToMill::Setup line) {
  const Timeline timeline(job, test_profile(), kMidway);
  settings.streaming = jobs::Streaming::full;
  AbortBench bench(job, timeline, std::move(mill), settings, line);
  bench.finish();
  return bench.sender().measured_pace();
}

}  // namespace axisgate::rml1
