// Finds the longest piece of a job that must be one write, however small the window is.
#pragma once

#include <string_view>

#include "device/jobs/check.h"
#include "device/jobs/place.h"
#include "device/rml1/sending/cut_places.h"

namespace axisgate::rml1 {

// Takes a job from its first byte on.
class LongestPiece {
 public:
  void take(std::string_view bytes);
  // Returns the longest piece of the bytes taken that cannot be cut; the first of several.
  const jobs::Piece& longest() const { return longest_; }

 private:
  CutPlaces places_;
  jobs::Place next_;
  jobs::Piece piece_, longest_;
};

}  // namespace axisgate::rml1
