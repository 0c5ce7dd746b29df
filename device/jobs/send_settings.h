// Settings for sending the jobs of a mill.
#pragma once

#include <cstddef>

namespace axisgate::jobs {

enum class Streaming { paced, full };

// Reaction to a line that broke while a job ran: when the line is open again, send an abort, or leave the mill alone.
enum class AtLoss { abort, leave };

struct SendSettings {
  Streaming streaming = Streaming::paced;
  std::size_t window = 0;          // in bytes, for paced streaming; 0: adapted to each job
  double slack = 1.5;              // how many times as long as the slowest mill of its profile a mill may take
  bool slack_as_measured = false;  // true: the measured pace, if there is one, replaces `slack`
  std::size_t buffer = 1024;       // size of the mill's buffer, in bytes
  std::size_t converter = 512;     // size of the buffer of a converter between host and mill, in bytes
  int baud = 9600;
  bool flow_control = false;  // the line stops the host when the mill has no room for more bytes
};

}  // namespace axisgate::jobs
