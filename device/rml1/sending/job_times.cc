#include "device/rml1/sending/job_times.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>

#include "device/rml1/sending/cut.h"
#include "device/rml1/sending/delivery.h"
#include "device/rml1/sending/pace.h"

namespace axisgate::rml1 {
namespace {

float seconds(TimePoint at) { return std::chrono::duration<float>(at.time_since_epoch()).count(); }

Duration from_seconds(float seconds) {
  return std::chrono::duration_cast<Duration>(std::chrono::duration<float>(std::max(seconds, 0.0F)));
}

// Factor for arrival times: a sender checks its line only at intervals, so commands are sent a little late.
constexpr double kLater = 1.01;

void arrive(Pace& pace, std::uint64_t through, TimePoint at) {
  pace.executed(at);
  pace.arrived(through, at);
}

// Returns the number of bytes of the job up to the end of its last step.
std::uint64_t end_of(const Timeline& timeline) { return timeline.steps().empty() ? 0 : timeline.steps().back().end; }

}  // namespace

JobTimes::JobTimes(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings,
                   std::size_t window) {
  if (settings.streaming == jobs::Streaming::full) {
    add_full(job, timeline, settings, window);
  } else {
    add_paced(job, timeline, settings, window);
  }
}

// Bytes are sent at the pace of the slowest mill, so a faster mill waits for them.
void JobTimes::add_paced(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings,
                         std::size_t window) {
  Delivery slowest(timeline, &Step::slowest_s, settings.slack, settings.baud, window);
  Pace fast(timeline, &Step::least_s, 1), slow(timeline, &Step::most_s, 1);
  for (Cutter cutter(job, window); cutter.begin() < end_of(timeline); cutter.next()) {
    const TimePoint arrives = slowest.send(cutter.begin(), cutter.end());
    arrive(fast, cutter.end(), arrives);
    arrive(slow, cutter.end(), TimePoint() + std::chrono::duration_cast<Duration>(arrives.time_since_epoch() * kLater));
    moments_.push_back({cutter.end(), seconds(fast.when(cutter.end())), seconds(slow.when(cutter.end()))});
  }
}

// A mill that has stopped its line accepts more bytes only after a part of its buffer is empty, so the high end is
// computed with half of the buffer.
void JobTimes::add_full(std::string_view job, const Timeline& timeline, const jobs::SendSettings& settings,
                        std::size_t window) {
  Delivery fast(timeline, &Step::least_s, 1, settings.baud, std::nullopt);
  Delivery slow(timeline, &Step::most_s, 1, settings.baud, settings.buffer / 2);
  for (Cutter cutter(job, window); cutter.begin() < end_of(timeline); cutter.next()) {
    fast.send(cutter.begin(), cutter.end());
    slow.send(cutter.begin(), cutter.end());
    moments_.push_back({cutter.end(), seconds(fast.executed()), seconds(slow.executed())});
  }
}

JobTimes::Moment JobTimes::at(std::uint64_t executed) const {
  const auto next = std::ranges::upper_bound(moments_, executed, {}, &Moment::end);
  return next == moments_.begin() ? Moment{} : *std::prev(next);
}

jobs::TimeRange JobTimes::left(std::uint64_t executed_least, std::uint64_t executed_most) const {
  if (moments_.empty()) return {};
  const Moment& end = moments_.back();
  return {from_seconds(end.least - at(executed_most).least), from_seconds(end.most - at(executed_least).most)};
}

}  // namespace axisgate::rml1
