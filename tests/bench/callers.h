// Callers who ask one question after another, each on a thread of its own.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

namespace axisgate::bench {

struct Load {
  int callers = 1;
  double seconds = 1;
  double warm_up = 0.3;  // seconds in which connections are made and nothing is counted
  int pause_ms = 0;      // of a caller, between an answer and its next question
};

// Asks once, and throws where that fails.
using Ask = std::function<void()>;
// Called on the caller's thread; callers count from 0.
using MakeAsk = std::function<Ask(int caller)>;

// The latencies of what was asked within the seconds, how many that is per second, and the calls of the warm-up, too.
nlohmann::json measure_callers(const Load& load, const MakeAsk& make_ask);

}  // namespace axisgate::bench
