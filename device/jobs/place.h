// Place in a job.
#pragma once

#include <cstdint>
#include <string_view>

namespace axisgate::jobs {

struct Place {
  std::uint64_t offset = 0;  // bytes, from 0
  std::uint64_t line = 1;    // ends at LF
  std::uint64_t column = 1;  // bytes, from 1

  friend bool operator==(const Place&, const Place&) = default;
};

// Returns the place after `c`, which is at `place`.
inline Place after(const Place& place, char c) {
  return c == '\n' ? Place{place.offset + 1, place.line + 1, 1} : Place{place.offset + 1, place.line, place.column + 1};
}

// Range within which an end lies that is not known exactly.
struct PlaceRange {
  Place least, most;

  friend bool operator==(const PlaceRange&, const PlaceRange&) = default;
};

// Returns the byte at which a line, or a column of it, begins; both count from 1. Returns the size for a place after
// the end.
std::uint64_t offset_of(std::string_view body, std::uint64_t line, std::uint64_t column);
Place place_of(std::string_view body, std::uint64_t offset);

}  // namespace axisgate::jobs
