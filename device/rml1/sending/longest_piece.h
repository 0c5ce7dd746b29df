// What of a job is one write, however small the window is.
#pragma once

#include <cstdint>
#include <string_view>

#include "device/rml1/place.h"
#include "device/rml1/sending/cut_places.h"

namespace axisgate::rml1 {

// Takes a job from its first byte on.
class LongestPiece {
 public:
  struct Piece {
    Place begin;
    std::uint64_t bytes = 0;
  };

  void take(std::string_view bytes);
  // Of what was taken, the longest piece without a place to cut it; the first of several.
  const Piece& longest() const { return longest_; }

 private:
  CutPlaces places_;
  Place next_;
  Piece piece_, longest_;
};

}  // namespace axisgate::rml1
