// The outcome of a motion, reported to a person and as an exit code.
#pragma once

#include <functional>
#include <string>

#include "clients/axisctl/motion_follower.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Waits for the outcome; throws Failure when the daemon can no longer be asked.
v1::Motion await_outcome(const Session& session, const std::string& motion);

// "axis x at 2.5 mm, axis y at 0 mm": where the axes are whose ends are known; may be empty.
std::string ends_text(const v1::Device& device, const v1::Motion& motion);

// Prints where the axes are, or throws the Failure that the outcome is.
int report_outcome(const Session& session, const v1::Device& device, const v1::Motion& motion);

// A motion that was started and is not waited for.
int report_started(const Session& session, const v1::Motion& motion);

// Starts it and waits for the outcome, which is reported; with --no-wait, once it has started. Throws Failure.
int start_and_wait(const Session& session, const v1::Device& device, const std::function<v1::Motion()>& start);

// From now on Ctrl-C says that the motion continues, before it ends axisctl with exit code 130.
void say_on_interrupt_that_motion_continues();

}  // namespace axisgate::axisctl
