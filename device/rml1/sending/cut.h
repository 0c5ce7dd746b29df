// Division of a job into writes.
#pragma once

#include <cstddef>
#include <string_view>

#include "device/rml1/sending/cut_places.h"

namespace axisgate::rml1 {

// A Cutter divides a job into writes, in their order. The job must outlive the Cutter. Each byte of the job is read
// only a few times, even if a command is long.
class Cutter {
 public:
  Cutter(std::string_view job, std::size_t window);

  // Range of the next write, in bytes of the job: one command, with the delimiters after it that fit into `window`. A
  // command longer than `window` is cut after the comma that follows a complete set of coordinates, if there is such a
  // comma. At the end of the job, begin() and end() are the size of the job.
  std::size_t begin() const { return begin_; }
  std::size_t end() const { return end_; }
  void next();

 private:
  std::size_t find_end();

  const std::string_view job_;
  const std::size_t window_;
  CutPlaces places_;  // has taken the bytes of the job before end_
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace axisgate::rml1
