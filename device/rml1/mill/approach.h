// How a job is continued in its middle: from which command on, and the way there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/rml1/machine.h"
#include "device/rml1/place.h"
#include "device/rml1/profile.h"
#include "device/rml1/stock.h"

namespace axisgate::rml1 {

struct Approach {
  Place at;           // of the part: what is sent again begins here, with a command or with a set of its coordinates
  std::string words;  // behind the prologue and before that; empty: nothing before it moves or sets anything
};

// To the first command of `body`, or set of its coordinates, at the byte `from` or behind it: the tool up, above the
// place, the modes as they are there, the spindle, the tool down. `body`: the bytes of a job's part, checked. `origin`:
// as of the check. invalid_request: there is no command, or no safe way, which the message says (README.md,
// "Continuing").
Result<Approach> approach_to(std::string_view body, std::uint64_t from, const Profile& profile,
                             std::optional<Origin> origin);

// What is then sent of the part, between prologue and epilogue.
std::string continued(std::string_view body, const Approach& approach);

// Of a place that a person has chosen. `body`: the part, as far as the mill may have been sent it. invalid_request: a
// command in it behind the place has set what nothing gives back: Z0, the spindle speed, the rotary axis.
Result<void> check_unchanged(std::string_view body, const Approach& approach, const Profile& profile,
                             std::optional<Origin> origin);

// Judges that as the part itself was judged. invalid_request: there is an error in it, or a warning of a kind that the
// part as a whole does not have.
Result<void> check_continued(std::string_view body, const Approach& approach, const Profile& profile,
                             std::optional<Origin> origin, std::optional<Stock> stock);

// The byte at which a line, or a column of one, begins; both count from 1. Behind the end: the size.
std::uint64_t offset_of(std::string_view body, std::uint64_t line, std::uint64_t column);
Place place_of(std::string_view body, std::uint64_t offset);

}  // namespace axisgate::rml1
