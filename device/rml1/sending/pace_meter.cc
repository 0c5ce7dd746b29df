#include "device/rml1/sending/pace_meter.h"

#include <algorithm>
#include <chrono>
#include <iterator>

namespace axisgate::rml1 {
namespace {

constexpr double kWithin = 1.2;  // greatest ratio of high end to low end in a range that is reported

double width(const jobs::MeasuredPace& pace) { return pace.most / pace.least; }

}  // namespace

jobs::SendSettings with_pace(jobs::SendSettings settings, const std::optional<jobs::MeasuredPace>& measured) {
  if (settings.slack_as_measured && measured) {
    settings.slack = std::max(measured->most * kUnsteady, 1.0);
  }
  return settings;
}

// The first step does not count: the tool's starting point is unknown, so the expected time of the step is unknown too.
void PaceMeter::stopped(std::uint64_t left, TimePoint now) {
  const auto& steps = timeline_.steps();
  if (steps.empty() || begun(left) <= steps.front().end) return;
  if (!first_) first_ = Stop{left, now};
  last_ = Stop{left, now};
}

void PaceMeter::interrupted() {
  before_ = pace();
  first_.reset();
  last_.reset();
}

std::optional<jobs::MeasuredPace> PaceMeter::pace() const {
  const auto now = between_stops();
  if (!now || width(*now) > kWithin) return before_;
  return before_ && width(*before_) <= width(*now) ? before_ : now;
}

// Compares the time between the first and the last stop with the durations of the steps executed in it. The steps that
// were certainly executed took no more than this time; all steps that may have been executed took no less.
std::optional<jobs::MeasuredPace> PaceMeter::between_stops() const {
  if (!first_) return std::nullopt;
  const double seconds = std::chrono::duration<double>(last_->at - first_->at).count();
  const double certain = slowest_s(first_->left + 1, begun(last_->left));
  const double possible = slowest_s(begun(first_->left), last_->left + 1);
  if (seconds <= 0 || certain <= 0) return std::nullopt;
  return jobs::MeasuredPace{seconds / possible, seconds / certain};
}

// Returns the end of the last command that the mill has certainly begun. All commands before it have been executed.
std::uint64_t PaceMeter::begun(std::uint64_t left) const {
  const auto& steps = timeline_.steps();
  const auto next = std::ranges::upper_bound(steps, left - std::min<std::uint64_t>(unread_, left), {}, &Step::end);
  return next == steps.begin() ? 0 : std::prev(next)->end;
}

// Returns the sum of `slowest`, in seconds, over the steps that end at the byte `from` or later, but before `to`.
double PaceMeter::slowest_s(std::uint64_t from, std::uint64_t to) const {
  return std::max(0.0, timeline_.slowest_until(std::max<std::uint64_t>(to, 1) - 1) -
                           timeline_.slowest_until(std::max<std::uint64_t>(from, 1) - 1));
}

}  // namespace axisgate::rml1
