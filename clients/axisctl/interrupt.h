// Behaviour of axisctl at Ctrl-C and similar signals.
#pragma once

namespace axisgate::axisctl {

// After this call, Ctrl-C prints "axisctl: " and `what` on the standard error, and ends axisctl with exit code 130.
// `what` must stay valid for as long as axisctl runs.
void say_on_interrupt(const char* what);

// Calls `handler` at each signal that asks a command to end: SIGINT, SIGTERM, and SIGHUP unless nohup(1) made axisctl
// ignore it. `flags` are those of sigaction(2).
void on_end_signals(void (*handler)(int), int flags);

}  // namespace axisgate::axisctl
