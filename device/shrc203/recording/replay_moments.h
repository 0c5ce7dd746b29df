// A recording as one row of happenings: what came to the line, and what the line did about it.
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
  int line = 0;                              // of the recording's text
  const RecordedExchange* begins = nullptr;  // with the bytes that begin an exchange
  bool of_exchange = false;                  // belongs to an exchange with a number

  bool begins_in(Lane lane) const { return begins && begins->lane == lane; }
};

// In time. They point into `recording`.
std::vector<Moment> moments_of(const Recording& recording);

// The first from which on the line's state is known: the line comes up, or is up and somebody's exchange begins. The
// number of moments where there is none. `header` becomes that of a recording which begins there.
std::size_t first_known(const std::vector<Moment>& moments, RecordingHeader& header);

// For people: wrote "?:V\r\n", ended ok, ...
std::string describe(Moment::What what, const std::string& text);

}  // namespace axisgate::shrc203
