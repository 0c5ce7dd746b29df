// What a measurement prints: "begun" once its warm-up is over, "ended" when its time is, and then its figures as one
// line of JSON. So the program that started it can look at the daemon's process at both moments.
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
  // In microseconds: p50, p99, min, max; and the count, alone where it is 0.
  nlohmann::json summary() const;

 private:
  std::vector<std::chrono::nanoseconds> times_;
};

void say_begun();
void say_ended();
void print(const nlohmann::json& figures);

}  // namespace axisgate::bench
