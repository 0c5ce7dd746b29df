#include "device/rml1/sending/plan.h"

#include <algorithm>
#include <chrono>

#include "device/jobs/guard.h"
#include "device/rml1/sending/cut.h"
#include "device/rml1/sending/delivery.h"
#include "device/rml1/sending/window.h"

namespace axisgate::rml1 {
namespace {

// A computed window is at most as large as the mill's buffer: without flow control, the mill loses bytes for which its
// buffer has no room.
std::size_t window_of(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings) {
  if (settings.window > 0) return settings.window;
  if (settings.streaming == jobs::Streaming::full) return kWindows[0];
  const std::size_t adapted = adapted_window(job, timeline, settings.slack, settings.baud);
  return guarded(jobs::MillGuard::window_fits_buffer) ? std::min(adapted, settings.buffer) : adapted;
}

std::size_t longest_write(std::string_view job, std::size_t window) {
  std::size_t longest = 0;
  for (Cutter cutter(job, window); cutter.begin() < job.size(); cutter.next()) {
    longest = std::max(longest, cutter.end() - cutter.begin());
  }
  return longest;
}

// Returns the largest sum of `amount` over the steps that end within any `bytes` consecutive bytes of the job.
double most_within(std::size_t bytes, const Timeline& timeline, float Step::*amount) {
  double most = 0, within = 0;
  auto first = timeline.steps().begin();
  for (const Step& last : timeline.steps()) {
    within += last.*amount;
    for (; first->end + bytes <= last.end; ++first) within -= (*first).*amount;
    most = std::max(most, within);
  }
  return most;
}

// RunOn::longest is the time to send plus the time to execute: at any moment the line sends or the mill executes,
// because a mill that stops the line has commands to execute.
jobs::RunOn run_on_of(std::size_t at_most, std::size_t if_held, const Timeline& timeline,
                      const jobs::SendSettings& settings) {
  const std::chrono::duration<double> executing(most_within(at_most, timeline, &Step::slowest_s) * settings.slack);
  return {at_most, if_held, std::chrono::ceil<Duration>(executing) + transmit_time(at_most, settings.baud),
          most_within(at_most, timeline, &Step::mm)};
}

}  // namespace

// `full` adds up the mill's buffer, a converter's buffer, the command that the mill executes, and the command that
// waits in the host.
SendPlan plan_of(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings) {
  const std::size_t window = window_of(job, timeline, settings);
  const std::size_t longest = longest_write(job, window);
  const std::size_t full = settings.buffer + settings.converter + 2 * longest;
  const std::size_t at_most =
      settings.streaming == jobs::Streaming::full ? full : std::min(std::max(window, longest), full);
  return {window, settings.slack, run_on_of(at_most, full, timeline, settings)};
}

}  // namespace axisgate::rml1
