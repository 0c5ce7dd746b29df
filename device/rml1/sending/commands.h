// Commands that are written before and after a job, so that its modes do not affect the next job, and to abort a job.
#pragma once

#include <string>

#include "device/core/time.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// Returns the commands that end an incomplete command in the mill and restore the default settings (guideline 3-1 DF).
std::string prologue();
// Returns the commands that raise the tool, stop the spindle and restore the default settings. `turning`: true if the
// spindle turns at the end of the job; then it stops only after the raise.
std::string epilogue(const Profile& profile, bool turning);
// Returns the commands that raise the tool to the top at Z's highest speed. They must follow PA.
std::string raise(const Profile& profile);
// Returns the commands of an abort; README.md gives the reason for their order. `may_rest`: true if the spindle may be
// stationary although it is permitted to turn; !MC0 then precedes the raise, which would start the spindle.
std::string abort_commands(const Profile& profile, bool may_rest);

// Returns the commands that raise the tool and then stop the spindle. They must follow complete commands. `may_rest`:
// as for abort_commands().
std::string raise_commands(const Profile& profile, bool may_rest);

// Returns the longest time of a straight move of `mm` from stop to stop, on a mill that needs `slack` times as long as
// the slowest mill of the profile.
Duration longest_move(double mm, double mm_per_s, const Profile& profile, double slack);

}  // namespace axisgate::rml1
