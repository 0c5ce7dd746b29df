// Output of a measurement: "begun" after its warm-up, "ended" at the end of its time, and then its figures as one line
// of JSON. The program that started it can look at the daemon's process at both moments.
#pragma once

#include <chrono>
#include <nlohmann/json.hpp>
#include <vector>

namespace axisgate::bench {

using Clock = std::chrono::steady_clock;

class Latencies {
 public:
  void add(std::chrono::nanoseconds time) { times_.push_back(time); }
  void add(const Latencies& others);
  // Returns p50, p99, min and max in microseconds, and the count. If the count is 0, returns only the count.
  nlohmann::json summary() const;

 private:
  std::vector<std::chrono::nanoseconds> times_;
};

void say_begun();
void say_ended();
void print(const nlohmann::json& figures);

}  // namespace axisgate::bench
