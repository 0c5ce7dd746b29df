#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

constexpr std::span<const Verb> (*kGroups[])() = {
    device_verbs, motion_verbs, path_verbs,    scan_verbs,    jog_verbs,      position_verbs,   stop_verbs,
    cancel_verbs, clear_verbs,  motions_verbs, command_verbs, settings_verbs, coordinate_verbs, signal_verbs,
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
