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
std::span<const Verb> cancel_verbs();
std::span<const Verb> clear_verbs();
std::span<const Verb> motions_verbs();
std::span<const Verb> command_verbs();
std::span<const Verb> settings_verbs();
std::span<const Verb> coordinate_verbs();
std::span<const Verb> signal_verbs();

int watch(const Session& session);
int record(const Session& session);
int replay(const Session& session);
int simulate(const Session& session);
int support(const Session& session);
int lease_run(const Session& session);
int lease_list(const Session& session);
int lease_hand_over(const Session& session);
int rearm(const Session& session);
int who_am_i(const Session& session);
int token_create(const Session& session);
int token_list(const Session& session);
int token_revoke(const Session& session);
int history(const Session& session);
int audit_verify(const Session& session);
int audit_erase(const Session& session);
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
