// What happened in a night, on one screen.
#pragma once

#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// From 18:00 yesterday, local time, or for the last --hours, until now. Returns its exit code or throws Failure.
int show_night(const Session& session);

}  // namespace axisgate::axisctl
