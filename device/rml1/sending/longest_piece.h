// Longest piece of a job that cannot be cut, so it must be sent in one write even if the window is smaller.
#pragma once

#include <string_view>

#include "device/jobs/check.h"
#include "device/jobs/place.h"
#include "device/rml1/sending/cut_places.h"

namespace axisgate::rml1 {

// A LongestPiece must take all bytes of the job, from the first one.
class LongestPiece {
 public:
  void take(std::string_view bytes);
  // Returns the longest piece that cannot be cut among the bytes taken; the first one if several have this length.
  const jobs::Piece& longest() const { return longest_; }

 private:
  CutPlaces places_;
  jobs::Place next_;
  jobs::Piece piece_, longest_;
};

}  // namespace axisgate::rml1
