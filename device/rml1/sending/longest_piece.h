// Finds the longest piece of a job that must be one write, however small the window is.
#pragma once

#include <cstdint>
#include <string_view>

#include "device/rml1/language/place.h"
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
  // Returns the longest piece of the bytes taken that cannot be cut; the first of several.
  const Piece& longest() const { return longest_; }

 private:
  CutPlaces places_;
  Place next_;
  Piece piece_, longest_;
};

}  // namespace axisgate::rml1
