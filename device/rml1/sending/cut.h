// A job in writes.
#pragma once

#include <cstddef>
#include <string_view>

#include "device/rml1/sending/cut_places.h"

namespace axisgate::rml1 {

// Goes through a job, write after write. The job outlives it. In all it reads each byte a few times, however long a
// command is.
class Cutter {
 public:
  Cutter(std::string_view job, std::size_t window);

  // The next write: a command, and the delimiters after it that are within `window`. A command that is longer is cut
  // after the comma of a complete set of coordinates, if it has one. At the end of the job both are its size.
  std::size_t begin() const { return begin_; }
  std::size_t end() const { return end_; }
  void next();

 private:
  std::size_t find_end();

  const std::string_view job_;
  const std::size_t window_;
  CutPlaces places_;  // has taken what is before the next write
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace axisgate::rml1
