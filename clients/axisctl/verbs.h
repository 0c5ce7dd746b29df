// Functions that run the verbs, one each. Each returns its exit code, or throws Failure.
#pragma once

#include <span>

#include "clients/axisctl/session.h"
#include "clients/axisctl/verb.h"

namespace axisgate::axisctl {

std::span<const Verb> device_verbs();
std::span<const Verb> motion_verbs();
std::span<const Verb> path_verbs();
std::span<const Verb> scan_verbs();
std::span<const Verb> jog_verbs();
std::span<const Verb> position_verbs();
std::span<const Verb> stop_verbs();
std::span<const Verb> rearm_verbs();
std::span<const Verb> cancel_verbs();
std::span<const Verb> clear_verbs();
std::span<const Verb> history_verbs();
std::span<const Verb> motions_verbs();
std::span<const Verb> audit_verbs();
std::span<const Verb> command_verbs();
std::span<const Verb> watch_verbs();
std::span<const Verb> lease_verbs();
std::span<const Verb> token_verbs();
std::span<const Verb> sim_verbs();
std::span<const Verb> record_verbs();
std::span<const Verb> replay_verbs();
std::span<const Verb> support_verbs();
std::span<const Verb> settings_verbs();
std::span<const Verb> coordinate_verbs();
std::span<const Verb> signal_verbs();

int mill_send(const Session& session);
int mill_queue(const Session& session);
int mill_confirm(const Session& session);
int mill_start(const Session& session);
int mill_watch(const Session& session);
int mill_pause(const Session& session);
int mill_resume(const Session& session);
int mill_abort(const Session& session);
int mill_cancel(const Session& session);
int mill_clear(const Session& session);
int mill_first(const Session& session);
int mill_done(const Session& session);
int mill_jog(const Session& session);
int mill_origin(const Session& session);
int mill_spindle(const Session& session);
int mill_raise(const Session& session);
int mill_again(const Session& session);
// Runs `mill send --rest-of`.
int mill_send_rest(const Session& session);

// Runs a verb. With --wait, first waits for a lease and runs the verb under it.
int with_lease(const Session& session, int (*verb)(const Session&));

}  // namespace axisgate::axisctl
