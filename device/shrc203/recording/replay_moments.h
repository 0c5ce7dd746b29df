// A recording as one sequence of moments: input to the line, and what the line did.
#pragma once

#include <string>
#include <vector>

#include "device/shrc203/stage.h"
#include "device/stage/recording/recording.h"

namespace axisgate::shrc203 {

struct Moment {
  enum class What {
    written,
    received,
    ended,
    completion,
    unexpected,
    connecting,
    up,
    down,
    barrier,
    barrier_passed,
    same_controller,
    ready,
    busy,
  };
  What what = What::written;
  std::string text{};  // bytes, outcome, axis number, line or reason
  AxisSet axes{};
  TimePoint at{};
  int line = 0;                              // line number in the recording
  const RecordedExchange* begins = nullptr;  // set if these bytes begin an exchange
  bool of_exchange = false;                  // part of a numbered exchange

  bool begins_in(Lane lane) const { return begins && begins->lane == lane; }
};

// Returns the moments in order of time. They point into `recording`.
std::vector<Moment> moments_of(const Recording& recording);

// Returns the index of the first moment from which the line's state is known: the line comes up, or it is up and a
// caller's exchange begins. Returns the number of moments if there is none. `header` becomes the header of a recording
// that begins there.
std::size_t first_known(const std::vector<Moment>& moments, RecordingHeader& header);

// Describes a moment for people: wrote "?:V\r
// ", ended ok, ...
std::string describe(Moment::What what, const std::string& text);

}  // namespace axisgate::shrc203
