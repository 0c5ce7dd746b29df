// The verbs. Each returns its exit code or throws Failure.
#pragma once

#include "clients/axisctl/session.h"

namespace axisgate::axisctl {

int devices(const Session& session);
int status(const Session& session);
int position(const Session& session);
int clear(const Session& session);
int commands(const Session& session);
int home(const Session& session);
int move(const Session& session);
int path(const Session& session);
int jog(const Session& session);
int stop(const Session& session);
int emergency_stop(const Session& session);
int execute(const Session& session);
int watch(const Session& session);
int record(const Session& session);
int replay(const Session& session);
int support(const Session& session);
int lease_run(const Session& session);
int lease_list(const Session& session);
int lease_hand_over(const Session& session);
int rearm(const Session& session);
int who_am_i(const Session& session);
int token_create(const Session& session);
int token_list(const Session& session);
int token_revoke(const Session& session);

// With --wait under a lease of its own, which is waited for.
int with_lease(const Session& session, int (*verb)(const Session&));

}  // namespace axisgate::axisctl
