#include "device/rml1/sending/plan.h"

#include <algorithm>

#include "device/rml1/guard.h"
#include "device/rml1/sending/cut.h"
#include "device/rml1/sending/window.h"

namespace axisgate::rml1 {
namespace {

// Without flow control the mill loses what its buffer has no room for.
std::size_t window_of(std::string_view job, const Timeline& timeline, const SendSettings& settings) {
  if (settings.window > 0) return settings.window;
  if (settings.streaming == Streaming::full) return kWindows[0];
  const std::size_t adapted = adapted_window(job, timeline, settings.slack, settings.baud);
  return guarded(MillGuard::window_fits_buffer) ? std::min(adapted, settings.buffer) : adapted;
}

std::size_t longest_write(std::string_view job, std::size_t window) {
  std::size_t longest = 0;
  for (Cutter cutter(job, window); cutter.begin() < job.size(); cutter.next()) {
    longest = std::max(longest, cutter.end() - cutter.begin());
  }
  return longest;
}

}  // namespace

// The mill's buffer may be full while it executes a command, and another one is in the host.
SendPlan plan_of(std::string_view job, const Timeline& timeline, const SendSettings& settings) {
  const std::size_t window = window_of(job, timeline, settings);
  const std::size_t longest = longest_write(job, window);
  const std::size_t full = settings.buffer + settings.converter + 2 * longest;
  if (settings.streaming == Streaming::full) return {window, {full, full}};
  return {window, {std::min(std::max(window, longest), full), full}};
}

}  // namespace axisgate::rml1
