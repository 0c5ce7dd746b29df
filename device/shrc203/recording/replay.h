// Feeds a recording to the present line core and compares the results: the written bytes and their order, the outcomes
// of the exchanges, and the interpretation of all received bytes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "device/shrc203/stage.h"
#include "device/stage/recording/recording.h"

namespace axisgate::shrc203 {

struct ReplayDifference {
  int line = 0;          // line number in the recording
  std::string recorded;  // for example "ended ok" or "nothing"
  std::string now;       // result of the present core, in the same form
};

struct ReplayReport {
  // Differences in the recording's order. After the first one, much of the rest often differs as well, so the replay
  // ends after kDifferencesMax.
  static constexpr std::size_t kDifferencesMax = 20;
  std::vector<ReplayDifference> differences;

  // First line that was compared: the line's state is known from there on. 0: never known, nothing was compared.
  int first_line = 0;
  std::uint64_t exchanges = 0;  // number of exchanges compared
  std::uint64_t bytes_written = 0, bytes_received = 0;
};

// Deterministic: all times come from the recording. Commands are requested at the times when they were written, in
// their lane and for their caller, and bytes are received at their recorded times.
ReplayReport replay(const Recording& recording);

}  // namespace axisgate::shrc203
