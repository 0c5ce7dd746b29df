// Functions shared by the verbs that call a mill. All throw Failure.
#pragma once

#include <string>

#include "axisgate/v1/mill.pb.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// Returns the name of the mill in the options, "devices/mill"; otherwise asks the daemon for its only mill.
std::string chosen_mill(const Session& session);

// Like chosen_mill(), for a mutation. After this call, a mutation whose answer was lost is sent again
// (Connection::repeat_by()).
std::string mill_to_change(const Session& session);

v1::Mill mill_now(const Session& session, const std::string& device);

// Returns the name of the job whose number was typed, "devices/mill/jobs/7". Without a number, the first job that
// waits, is confirmed, is in a tool change, or is PAUSED.
std::string wanted_job(const Session& session, const v1::Mill& mill);
// Like wanted_job(), but without a number returns the first job that is FED.
std::string fed_job(const Session& session, const v1::Mill& mill);

// Runs `mill send --rest-of`. Defined beside `mill again`, which makes the same call.
int mill_send_rest(const Session& session);

}  // namespace axisgate::axisctl
