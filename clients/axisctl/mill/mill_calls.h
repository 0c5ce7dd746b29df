// What the verbs share that call a mill. All throw Failure.
#pragma once

#include <string>

#include "axisgate/v1/mill.pb.h"
#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

// "devices/mill", as it was named; otherwise the only one, for which the daemon is asked.
std::string chosen_mill(const Session& session);

// The same for a request that changes something: from now on it is repeated where its answer is lost.
std::string mill_to_change(const Session& session);

v1::Mill mill_now(const Session& session, const std::string& device);

// "devices/mill/jobs/7" of the number that was typed; without one, of the first job that waits, is confirmed, is in a
// tool change, or is PAUSED.
std::string wanted_job(const Session& session, const v1::Mill& mill);
// The same, without a number of the job that is FED.
std::string fed_job(const Session& session, const v1::Mill& mill);

}  // namespace axisgate::axisctl
