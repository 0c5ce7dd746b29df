#include "device/rml1/sending/window.h"

#include <algorithm>
#include <chrono>
#include <iterator>

#include "device/rml1/sending/cut.h"
#include "device/rml1/sending/pace.h"

namespace axisgate::rml1 {
namespace {

constexpr int kBitsAByte = 10;
constexpr double kHardlyLonger = 1.01;

// Until the last byte has been executed. A command is written when the one before has left, and the window has room.
Duration job_time(std::string_view job, const Timeline& timeline, double slower, int baud, std::size_t window) {
  Pace pace(timeline, &Step::most_s, slower);
  TimePoint now{};
  for (Cutter cutter(job, window); cutter.begin() < job.size(); cutter.next()) {
    const std::size_t begin = cutter.begin(), end = cutter.end();
    const std::size_t over = end > window ? end - window : 0;
    now = std::max(now, pace.when(std::min(over, begin)));
    pace.executed(now);
    now += transmit_time(end - begin, baud);
    pace.arrived(end, now);
  }
  return pace.when(job.size()).time_since_epoch();
}

}  // namespace

Duration transmit_time(std::size_t bytes, int baud) {
  return std::chrono::duration_cast<Duration>(
      std::chrono::duration<double>(static_cast<double>(bytes) * kBitsAByte / baud));
}

std::size_t adapted_window(std::string_view job, const Timeline& timeline, double slower, int baud) {
  const auto time = [&](std::size_t window) { return job_time(job, timeline, slower, baud, window); };
  const auto most = time(*std::rbegin(kWindows)) * kHardlyLonger;
  return *std::ranges::find_if(kWindows, [&](std::size_t window) { return time(window) <= most; });
}

}  // namespace axisgate::rml1
