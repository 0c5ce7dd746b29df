#include "tests/bench/measurement.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace axisgate::bench {
namespace {

void print_line(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

}  // namespace

void Latencies::add(const Latencies& others) {
  times_.insert(times_.end(), others.times_.begin(), others.times_.end());
}

nlohmann::json Latencies::summary() const {
  nlohmann::json figures;
  figures["count"] = times_.size();
  if (times_.empty()) return figures;
  auto sorted = times_;
  std::ranges::sort(sorted);
  const auto at = [&](double share) {
    const auto place = static_cast<std::size_t>(share * static_cast<double>(sorted.size()));
    const std::chrono::duration<double, std::micro> time = sorted[std::min(place, sorted.size() - 1)];
    return std::round(time.count() * 10) / 10;
  };
  figures["p50"] = at(0.5);
  figures["p99"] = at(0.99);
  figures["min"] = at(0);
  figures["max"] = at(1);
  return figures;
}

void say_begun() { print_line("begun"); }
void say_ended() { print_line("ended"); }
void print(const nlohmann::json& figures) { print_line(figures.dump()); }

}  // namespace axisgate::bench
