// Feeds a recording to the line's core of today and compares: the bytes written, in their order, the exchanges'
// outcomes, and what was made of all that came.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/shrc203/stage.h"
#include "device/stage/recording/recording.h"

namespace axisgate::shrc203 {

struct ReplayDifference {
  int line = 0;          // of the recording's text
  std::string recorded;  // such as: ended ok; nothing
  std::string now;       // the same of the core
};

struct ReplayReport {
  // In the recording's order. Where the core has taken another way much that follows differs as well, so that after
  // kDifferencesMax the replay ends.
  static constexpr std::size_t kDifferencesMax = 20;
  std::vector<ReplayDifference> differences;

  // From here on there was enough to know the line's state: nothing before it was compared. 0: nowhere.
  int first_line = 0;
  std::uint64_t exchanges = 0;  // compared
  std::uint64_t bytes_written = 0, bytes_received = 0;
};

// Deterministic: time is the recording's. Commands are requested when they were written, in their lane and for their
// caller, and bytes come in when they came.
ReplayReport replay(const Recording& recording);

}  // namespace axisgate::shrc203
