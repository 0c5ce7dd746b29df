// Load from callers that ask one question after another, each on a separate thread.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>

namespace axisgate::bench {

struct Load {
  int callers = 1;
  double seconds = 1;
  double warm_up = 0.3;  // seconds for making connections, before the measurement
  int pause_ms = 0;      // pause of a caller between an answer and the next question
};

// Asks one question. Throws if it fails.
using Ask = std::function<void()>;
// Creates the Ask of a caller, on the caller's thread. Callers are numbered from 0.
using MakeAsk = std::function<Ask(int caller)>;

// Returns the latencies and the rate per second of the questions that began within the measured seconds, and the number
// of all calls, including the warm-up.
nlohmann::json measure_callers(const Load& load, const MakeAsk& make_ask);

}  // namespace axisgate::bench
