// Continuing a job in its middle: the place at which it continues, and the approach to this place.
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
  jobs::Place at;     // place in the part from which it is sent: the beginning of a command or of a set of coordinates
  std::string words;  // commands between the prologue and the bytes at `at`; empty if no command comes before `at`
};

// Returns the approach to the first command or set of coordinates in `body` that begins at the byte `from` or later.
// The approach raises the tool, moves it above the place, sets the modes of that place, starts the spindle, and lowers
// the tool. `body`: checked bytes of a job's part. `origin`: the origin of the check. Fails with invalid_request if no
// command begins there or later, or if no safe approach exists (README.md, "Continuing in the middle").
Result<Approach> approach_to(std::string_view body, std::uint64_t from, const Profile& profile,
                             std::optional<jobs::Origin> origin);

// Returns the bytes to send between prologue and epilogue: the approach, and the part from `approach.at` on.
std::string continued(std::string_view body, const Approach& approach);

// Checks a place that a person has chosen. `body`: the bytes of the part that may have been sent to the mill. Fails
// with invalid_request if `body` contains, after the place, the first command that sets Z0 or the spindle speed or
// turns the rotary axis: the mill may have executed it, and no command can undo it.
Result<void> check_unchanged(std::string_view body, const Approach& approach, const Profile& profile,
                             std::optional<jobs::Origin> origin);

// Checks the continued part like a whole part. Fails with invalid_request if the continued part has an error, or a kind
// of warning that the whole part does not have.
Result<void> check_continued(std::string_view body, const Approach& approach, const Profile& profile,
                             std::optional<jobs::Origin> origin, std::optional<jobs::Stock> stock);

}  // namespace axisgate::rml1
