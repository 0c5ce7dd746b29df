// How slow a mill is, from how fast a line that it stops takes the bytes of a job. README.md says what that can show.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "device/core/time.h"
#include "device/rml1/sending/settings.h"
#include "device/rml1/sending/timeline.h"

namespace axisgate::rml1 {

// The mill takes so many times as long as the slowest of its profile: a range.
struct MeasuredPace {
  double least = 0, most = 0;

  friend bool operator==(const MeasuredPace&, const MeasuredPace&) = default;
};

// By how much what follows may be slower or faster than what was measured.
inline constexpr double kUnsteady = 1.1;

// Where `slack_as_measured`, with that slack.
SendSettings with_pace(SendSettings settings, const std::optional<MeasuredPace>& measured);

// Of one job. Not thread safe.
class PaceMeter {
 public:
  // `unread`: bytes that have left the host and that the mill has not read, at most. `timeline` outlives this.
  PaceMeter(const Timeline& timeline, std::size_t unread) : timeline_(timeline), unread_(unread) {}

  // The mill stops the line, and so many bytes of the job have left the host by then. Both ascend.
  void stopped(std::uint64_t left, TimePoint now);
  // From here on the mill may have waited for bytes.
  void interrupted();

  // Nothing where the line was not stopped over enough of the job to have the range within a fifth.
  std::optional<MeasuredPace> pace() const;

 private:
  struct Stop {
    std::uint64_t left = 0;
    TimePoint at{};
  };

  std::optional<MeasuredPace> between_stops() const;
  std::uint64_t begun(std::uint64_t left) const;
  double slowest_s(std::uint64_t from, std::uint64_t to) const;

  const Timeline& timeline_;
  const std::size_t unread_;
  std::optional<Stop> first_, last_;    // since it was interrupted
  std::optional<MeasuredPace> before_;  // it was: the narrowest
};

}  // namespace axisgate::rml1
