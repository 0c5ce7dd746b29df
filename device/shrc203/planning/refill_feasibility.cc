#include "device/shrc203/planning/refill_feasibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "device/shrc203/command/builders.h"
#include "device/shrc203/limits.h"

namespace axisgate::shrc203 {
namespace {

constexpr std::size_t kAxisNumberBytes = 1 + LineTiming::kTerminator;
constexpr std::size_t kChainedBytes = 4 + LineTiming::kTerminator;  // OK_D

double milliseconds_of(Duration duration) { return std::chrono::duration<double, std::milli>(duration).count(); }

// Rounds up, so that a segment of the reported duration is feasible.
std::string in_milliseconds(Duration duration) {
  return fmt::format("{} ms", std::ceil(milliseconds_of(duration) * 10) / 10);
}

}  // namespace

Command segment_setter(const PathPlan& plan, int number) {
  const SegmentPlan& segment = plan.segments[static_cast<std::size_t>(number - 1)];
  const auto speeds = speeds_of(segment.move);
  if (!segment.curve) return commands::set_setpoint(segment.reg(), amounts_of(segment.move), speeds);
  Arguments arguments = segment.curve->arguments;
  for (const auto& [axis, speed] : speeds) arguments.speeds(speed.minimum, speed.maximum, speed.acceleration_ms);
  auto setter = commands::set_curve(segment.curve->form, arguments);
  if (!setter) std::abort();  // the plan was encoded once already
  return *std::move(setter);
}

Duration shortest_feasible(const PathPlan& plan, int number, const LineTiming& timing) {
  const std::size_t axis_numbers = static_cast<std::size_t>(plan.axes.count()) * kAxisNumberBytes;
  const std::size_t setter = segment_setter(plan, number + 1).line.size() + LineTiming::kTerminator;
  return timing.time_of(axis_numbers + setter + kChainedBytes) + timing.usual_turnaround() + kRefillHostDelay;
}

Result<void> check_refill_feasibility(const PathPlan& plan, const LineTiming& timing) {
  const int count = static_cast<int>(plan.segments.size());
  int too_short = 0;
  Duration longest_needed{};
  for (int number = 1; number < count; ++number) {
    if (plan.segments[static_cast<std::size_t>(number)].waits()) continue;  // the next segment is set at READY
    const Duration needed = shortest_feasible(plan, number, timing);
    longest_needed = std::max(longest_needed, needed);
    const Duration lasts = plan.segments[static_cast<std::size_t>(number - 1)].shortest;
    if (too_short == 0 && lasts + kSegmentTimePrecision < needed) too_short = number;
  }
  if (too_short == 0) return {};
  const Duration lasts = plan.segments[static_cast<std::size_t>(too_short - 1)].shortest;
  return fail(
      Reason::too_fast,
      fmt::format("segment {} takes {:.1f} ms, in which a line of {} baud cannot set the next one: the shortest "
                  "feasible segment time is {}",
                  too_short, milliseconds_of(lasts), timing.baud(),
                  in_milliseconds(shortest_feasible(plan, too_short, timing))),
      fmt::format("let every segment but the last take {} or more: longer or slower ones, or a higher baud rate",
                  in_milliseconds(longest_needed)));
}

}  // namespace axisgate::shrc203
