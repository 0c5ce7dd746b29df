#include "device/shot/line/line_timing.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "device/shot/command/model.h"
#include "device/shot/limits.h"

namespace axisgate::shot {
namespace {

constexpr std::string_view kLongestAcknowledgement = "OK_D";

}  // namespace

Duration LineTiming::time_of(std::size_t bytes) const {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(bytes) * 10 * 1'000'000'000 / baud_);
}

std::size_t LineTiming::reply_bytes_max() const {
  constexpr std::size_t kOthers = 64, kAxisBytes = 21;  // of an axis: a coordinate, its status and READY
  return std::max(kOthers, 1 + kAxisBytes * static_cast<std::size_t>(axis_count_));
}

void LineTiming::answered(std::size_t line_bytes, std::size_t reply_bytes, Duration latency) {
  const Duration on_the_wire = time_of(line_bytes + reply_bytes + 2 * kTerminator);
  turnarounds_.push_back(std::max(Duration::zero(), latency - on_the_wire));
  if (turnarounds_.size() > kKept) turnarounds_.pop_front();
}

Duration LineTiming::usual_turnaround() const {
  if (turnarounds_.empty()) return kTurnaroundAssumed;
  std::vector<Duration> sorted(turnarounds_.begin(), turnarounds_.end());
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  return *middle;
}

Duration LineTiming::longest_turnaround() const {
  return turnarounds_.empty() ? kTurnaroundAssumed : *std::ranges::max_element(turnarounds_);
}

Duration LineTiming::longest_exchange(const Command& command) const {
  const auto lasts = [this](std::size_t bytes) { return time_of(bytes + 2 * kTerminator) + longest_turnaround(); };
  const std::size_t line = command.line.size();
  // Questions need no ?:CMD after NG: a mode that refuses them also prevents motion along a path.
  if (command.row->effect == Effect::question) return lasts(line + reply_bytes_max());
  // The ?:CMD after NG, whose reply is the refused line.
  const std::size_t after_refusal = text(LineQuestion::line_before).size();
  return lasts(line + kLongestAcknowledgement.size()) + lasts(after_refusal + line);
}

}  // namespace axisgate::shot
