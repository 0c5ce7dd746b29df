// Groups of verbs: one function for each file that has verbs, defined there.
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
std::span<const Verb> mill_verbs();
std::span<const Verb> mill_send_verbs();
std::span<const Verb> mill_repeat_verbs();
std::span<const Verb> mill_queue_verbs();
std::span<const Verb> mill_confirm_verbs();
std::span<const Verb> mill_job_verbs();
std::span<const Verb> mill_hand_verbs();

// Runs a verb. With --wait, first waits for a lease and runs the verb under it.
int with_lease(const Session& session, int (*verb)(const Session&));

}  // namespace axisgate::axisctl
