#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

constexpr std::span<const Verb> (*kGroups[])() = {
    device_verbs,    motion_verbs,    path_verbs,        scan_verbs,       jog_verbs,          position_verbs,
    stop_verbs,      rearm_verbs,     cancel_verbs,      clear_verbs,      history_verbs,      motions_verbs,
    audit_verbs,     command_verbs,   watch_verbs,       lease_verbs,      token_verbs,        sim_verbs,
    record_verbs,    replay_verbs,    support_verbs,     settings_verbs,   coordinate_verbs,   signal_verbs,
    mill_verbs,      mill_send_verbs, mill_repeat_verbs, mill_queue_verbs, mill_confirm_verbs, mill_job_verbs,
    mill_hand_verbs,
};

}  // namespace

std::vector<const Verb*> verbs() {
  std::vector<const Verb*> all;
  for (const auto group : kGroups) {
    for (const Verb& verb : group()) all.push_back(&verb);
  }
  return all;
}

}  // namespace axisgate::axisctl
