// What a job with `full` streaming shows of the simulated mill's pace.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "device/rml1/sending/pace_meter.h"
#include "tests/rml1/abort_bench.h"
#include "tests/rml1/trace.h"

namespace axisgate::rml1 {

// `line`: as the host sees it; its converter is among the settings, too.
inline std::optional<MeasuredPace> measured_by(const std::string& job, simulator::MillSetup mill, SendSettings settings,
                                               LineToMill::Setup line) {
  const Timeline timeline(job, test_profile(), kMidway);
  settings.streaming = Streaming::full;
  AbortBench bench(job, timeline, std::move(mill), settings, line);
  bench.finish();
  return bench.sender().measured_pace();
}

}  // namespace axisgate::rml1
