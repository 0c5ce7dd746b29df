#include "device/rml1/sending/window.h"

#include <algorithm>
#include <iterator>

#include "device/rml1/sending/cut.h"
#include "device/rml1/sending/delivery.h"

namespace axisgate::rml1 {
namespace {

constexpr double kHardlyLonger = 1.01;

// Returns the time until the last byte has been executed.
Duration job_time(std::string_view job, const Timeline& timeline, double slower, int baud, std::size_t window) {
  Delivery delivery(timeline, &Step::slowest_s, slower, baud, window);
  for (Cutter cutter(job, window); cutter.begin() < job.size(); cutter.next()) {
    delivery.send(cutter.begin(), cutter.end());
  }
  return delivery.executed().time_since_epoch();
}

}  // namespace

std::size_t adapted_window(std::string_view job, const Timeline& timeline, double slower, int baud) {
  const auto time = [&](std::size_t window) { return job_time(job, timeline, slower, baud, window); };
  const auto most = time(*std::rbegin(kWindows)) * kHardlyLonger;
  return *std::ranges::find_if(kWindows, [&](std::size_t window) { return time(window) <= most; });
}

}  // namespace axisgate::rml1
