// Settings by which the jobs of a mill are sent.
#pragma once

#include <cstddef>

namespace axisgate::jobs {

enum class Streaming { paced, full };

enum class AtLoss { abort, leave };  // what is sent when the line is back, for a job that ran when it broke

struct SendSettings {
  Streaming streaming = Streaming::paced;
  std::size_t window = 0;          // bytes, of paced streaming; 0: adapted to the job
  double slack = 1.5;              // how many times as slow as the slowest of its profile a mill may be
  bool slack_as_measured = false;  // that, or less if the mill's pace was measured
  std::size_t buffer = 1024;       // bytes, the mill's
  std::size_t converter = 512;     // bytes, between host and mill
  int baud = 9600;
  bool flow_control = false;  // the line keeps the host from sending what the mill has no room for
};

}  // namespace axisgate::jobs
