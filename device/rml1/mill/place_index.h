// Lines and columns within a long text.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "device/rml1/place.h"

namespace axisgate::rml1 {

// Immutable. Reads the text once; after that a place takes no longer where the text is longer.
class PlaceIndex {
 public:
  // The text outlives this.
  explicit PlaceIndex(std::string_view text);

  // Of that byte; behind the end: where the text ends.
  Place at(std::uint64_t offset) const;

 private:
  static constexpr std::size_t kStep = 4096;

  const std::string_view text_;
  std::vector<Place> places_;  // of each kStep-th byte
};

}  // namespace axisgate::rml1
