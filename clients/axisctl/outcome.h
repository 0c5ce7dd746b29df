// Reports of a motion's outcome, as text and as an exit code.
#pragma once

#include <functional>
#include <string>

#include "clients/axisctl/motion_follower.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Waits for the outcome. Throws Failure if the daemon can no longer be asked.
v1::Motion await_outcome(const Session& session, const std::string& motion);

// Returns "axis x at 2.5 mm, axis y at 0 mm", for the axes whose end position is known; may be empty.
std::string ends_text(const v1::Device& device, const v1::Motion& motion);

// Prints the end positions of the axes. Throws Failure if the motion did not succeed.
int report_outcome(const Session& session, const v1::Device& device, const v1::Motion& motion);

// Prints that a motion was started, for --no-wait.
int report_started(const Session& session, const v1::Motion& motion);

// Starts a motion, waits for its outcome and reports it; with --no-wait, only reports the start. Throws Failure.
int start_and_wait(const Session& session, const v1::Device& device, const std::function<v1::Motion()>& start);

// After this call, Ctrl-C prints that the motion continues, and ends axisctl with exit code 130.
void say_on_interrupt_that_motion_continues();

}  // namespace axisgate::axisctl
