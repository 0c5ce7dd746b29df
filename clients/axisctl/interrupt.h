// What Ctrl-C means while axisctl follows something that it does not end.
#pragma once

namespace axisgate::axisctl {

// From now on Ctrl-C prints "axisctl: " and `what` on the standard error, and ends axisctl with exit code 130. `what`
// must exist for as long as axisctl runs.
void say_on_interrupt(const char* what);

}  // namespace axisgate::axisctl
