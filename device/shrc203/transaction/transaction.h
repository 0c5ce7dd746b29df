// A caller's transaction while it runs, with the data that its steps share.
#pragma once

#include <set>
#include <vector>

#include "device/shot/command/command.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/stage.h"
#include "device/shrc203/state/live_motion.h"
#include "device/shrc203/state/switch_audit.h"
#include "device/stage/stage_controller.h"

namespace axisgate::shrc203 {

struct Transaction {
  enum class Started { no, accepted, in_doubt };
  // State that the lines may have changed and that must be read again.
  enum class Changed { memory_switches, scale, everything };  // everything: the controller was reset

  const std::string& who() const { return request.context.who; }
  void tell_end(std::optional<Problem> problem) const;

  ExecuteRequest request;
  std::vector<Command> commands;
  StageController::OnExecute tell;
  LiveMotionPtr live{};     // null: questions and settings that may come between another caller's lines
  Positions destination{};  // saved position to which the transaction moves, if any
  Started started = Started::no;
  std::set<Changed> changed{};
  SwitchAudit audit{};
};

// Returns not_found, for a question about a saved position.
Problem nothing_saved(const Command& question);

}  // namespace axisgate::shrc203
