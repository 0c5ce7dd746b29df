#include "device/rml1/mill/place_index.h"

#include <algorithm>

namespace axisgate::rml1 {

PlaceIndex::PlaceIndex(std::string_view text) : text_(text) {
  jobs::Place place;
  for (const char c : text) {
    if (place.offset % kStep == 0) places_.push_back(place);
    place = after(place, c);
  }
  if (place.offset % kStep == 0) places_.push_back(place);
}

jobs::Place PlaceIndex::at(std::uint64_t offset) const {
  const std::size_t end = std::min<std::size_t>(offset, text_.size());
  jobs::Place place = places_[end / kStep];
  while (place.offset < end) place = after(place, text_[place.offset]);
  return place;
}

}  // namespace axisgate::rml1
