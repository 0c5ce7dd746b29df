// history --night: a summary of the night, on one screen.
#pragma once

#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Prints the summary from 18:00 yesterday, local time, or of the last --hours, until now. Returns the exit code, or
// throws Failure.
int show_night(const Session& session);

}  // namespace axisgate::axisctl
