// Bytes that are written around a job, so that its modes do not reach the next one, and to abort it.
#pragma once

#include <string>

#include "device/core/time.h"
#include "device/rml1/machine/profile.h"

namespace axisgate::rml1 {

// Ends what may be open in the mill, and sets the language's defaults (guideline 3-1 DF).
std::string prologue();
// The tool up, the spindle off, the defaults. `turning`: the job leaves the spindle turning; then the tool is raised
// before it stops.
std::string epilogue(const Profile& profile, bool turning);
// The tool to the top, at Z's highest speed. Behind PA.
std::string raise(const Profile& profile);
// README.md says why in this order. `may_rest`: the spindle may not be turning, and be permitted to.
std::string abort_words(const Profile& profile, bool may_rest);

// The tool up, and then the spindle off; sent after whole commands. `may_rest`: as of abort_words().
std::string lift_words(const Profile& profile, bool may_rest);

// A way that one axis goes from stop to stop, by a mill that is `slack` times as slow as the slowest of the profile.
Duration longest_way(double mm, double mm_per_s, const Profile& profile, double slack);

}  // namespace axisgate::rml1
