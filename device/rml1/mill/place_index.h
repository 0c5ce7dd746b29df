// Lines and columns of bytes in a long text.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "device/jobs/place.h"

namespace axisgate::rml1 {

// Immutable. Reads the text once; after that, the time to find a place does not depend on the length of the text.
class PlaceIndex {
 public:
  // The text must outlive this object.
  explicit PlaceIndex(std::string_view text);

  // Returns the place of the byte at `offset`, or the end of the text if `offset` is beyond the end.
  jobs::Place at(std::uint64_t offset) const;

 private:
  static constexpr std::size_t kStep = 4096;

  const std::string_view text_;
  std::vector<jobs::Place> places_;  // places of the bytes at the multiples of kStep
};

}  // namespace axisgate::rml1
