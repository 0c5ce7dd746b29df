// Place in a job.
#pragma once

#include <cstdint>
#include <string_view>

namespace axisgate::jobs {

struct Place {
  std::uint64_t offset = 0;  // in bytes, from 0
  std::uint64_t line = 1;    // from 1; each line ends at LF
  std::uint64_t column = 1;  // in bytes, from 1

  friend bool operator==(const Place&, const Place&) = default;
};

// Returns the place after `c`, which is at `place`.
inline Place after(const Place& place, char c) {
  return c == '\n' ? Place{place.offset + 1, place.line + 1, 1} : Place{place.offset + 1, place.line, place.column + 1};
}

// Range that contains a place which is not known exactly.
struct PlaceRange {
  Place least, most;

  friend bool operator==(const PlaceRange&, const PlaceRange&) = default;
};

// Returns the offset of a column in a line, both counted from 1. Returns the size of `body` for a place after its end.
std::uint64_t offset_of(std::string_view body, std::uint64_t line, std::uint64_t column);
Place place_of(std::string_view body, std::uint64_t offset);

}  // namespace axisgate::jobs
