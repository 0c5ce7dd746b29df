// Continues a job in its middle: the command to begin with, and the way there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/jobs/place.h"
#include "device/jobs/stock.h"
#include "device/rml1/machine/machine.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

struct Approach {
  jobs::Place at;     // place in the part where sending begins: a command, or a set of its coordinates
  std::string words;  // sent after the prologue and before the place; empty if nothing before it moves or sets anything
};

// Returns the approach to the first command of `body`, or set of its coordinates, at the byte `from` or after it: the
// tool up, above the place, the modes as they are there, the spindle, the tool down. `body`: bytes of a job's part,
// checked. `origin`: as of the check. Fails with invalid_request if there is no command, or no safe way (README.md,
// "Continuing").
Result<Approach> approach_to(std::string_view body, std::uint64_t from, const Profile& profile,
                             std::optional<jobs::Origin> origin);

// Returns the bytes that are then sent of the part, between prologue and epilogue.
std::string continued(std::string_view body, const Approach& approach);

// Checks a place that a person has chosen. `body`: the part, as far as the mill may have been sent it. Fails with
// invalid_request if a command of it after the place sets what no command can undo: Z0, the spindle speed, the rotary
// axis.
Result<void> check_unchanged(std::string_view body, const Approach& approach, const Profile& profile,
                             std::optional<jobs::Origin> origin);

// Judges the rest as the part itself was judged. Fails with invalid_request if it has an error, or a kind of warning
// that the whole part does not have.
Result<void> check_continued(std::string_view body, const Approach& approach, const Profile& profile,
                             std::optional<jobs::Origin> origin, std::optional<jobs::Stock> stock);

}  // namespace axisgate::rml1
