// Measures how slow a mill is by how fast a line that it stops takes the bytes of a job. README.md says what that can
// show.
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

// Returns the settings with the measured slack, if they say `slack_as_measured`.
jobs::SendSettings with_pace(jobs::SendSettings settings, const std::optional<jobs::MeasuredPace>& measured);

// A PaceMeter measures by one job. Not thread safe.
class PaceMeter {
 public:
  // `unread`: bytes that have left the host and that the mill has not read, at most. `timeline` outlives this.
  PaceMeter(const Timeline& timeline, std::size_t unread) : timeline_(timeline), unread_(unread) {}

  // Notes that the mill stops the line when so many bytes of the job have left the host. Both ascend.
  void stopped(std::uint64_t left, TimePoint now);
  // Notes that the mill may wait for bytes from here on.
  void interrupted();

  // Returns nullopt if the line was not stopped over enough of the job to know the range within a fifth.
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
  std::optional<Stop> first_, last_;          // since it was interrupted
  std::optional<jobs::MeasuredPace> before_;  // it was: the narrowest
};

}  // namespace axisgate::rml1
