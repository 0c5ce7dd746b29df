// Measurement of a mill's pace: how fast bytes of a job leave the host on a line that the mill stops when its buffer is
// full. README.md describes the limits of this measurement.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "device/core/time.h"
#include "device/jobs/measured_pace.h"
#include "device/jobs/send_settings.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// Factor by which the rest of a job may be slower or faster than its measured part.
inline constexpr double kUnsteady = 1.1;

// Returns the settings with a slack computed from the measured pace, if `slack_as_measured` is set and the pace was
// measured; otherwise returns them unchanged.
jobs::SendSettings with_pace(jobs::SendSettings settings, const std::optional<jobs::MeasuredPace>& measured);

// A PaceMeter measures the pace during one job. Not thread safe.
class PaceMeter {
 public:
  // `unread`: greatest possible number of bytes that have left the host but were not read by the mill. `timeline` must
  // outlive this object.
  PaceMeter(const Timeline& timeline, std::size_t unread) : timeline_(timeline), unread_(unread) {}

  // Notes that the mill stops the line at `now`, when `left` bytes of the job have left the host. Neither argument may
  // decrease from call to call.
  void stopped(std::uint64_t left, TimePoint now);
  // Notes that the mill may have to wait for bytes from now on, so that measuring must begin again.
  void interrupted();

  // Returns the measured pace. Returns nullopt until enough of the job was sent on a stopped line to give a range whose
  // high end is at most 1.2 times its low end.
  std::optional<jobs::MeasuredPace> pace() const;

 private:
  struct Stop {
    std::uint64_t left = 0;
    TimePoint at{};
  };

  std::optional<jobs::MeasuredPace> between_stops() const;
  std::uint64_t begun(std::uint64_t left) const;
  double slowest_s(std::uint64_t from, std::uint64_t to) const;

  const Timeline& timeline_;
  const std::size_t unread_;
  std::optional<Stop> first_, last_;          // since the last call of interrupted()
  std::optional<jobs::MeasuredPace> before_;  // narrowest range measured before that call
};

}  // namespace axisgate::rml1
