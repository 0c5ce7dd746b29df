// Explanation of NG: asks the controller until a reply explains it. Also refuses a motion if the reason is already
// known.
#pragma once

#include <optional>
#include <string>

#include "device/core/problem.h"
#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/registers.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class Explainer {
 public:
  Explainer(Dialogue& dialogue, Reader& reader, const Line& line, const StateStore& store, const Registers& registers,
            const NonHost& non_host, Tasks& tasks)
      : dialogue_(dialogue),
        reader_(reader),
        line_(line),
        store_(store),
        registers_(registers),
        non_host_(non_host),
        tasks_(tasks) {}

  // Returns the reason why the command for these axes was refused. Questions are asked in turn, and the first reply
  // that explains the refusal ends the search.
  Task<Problem> explain(Command command, AxisSet axes, std::string caller);
  // Returns the reason why a question was refused: another mode, or its values. nullopt if neither is the reason.
  Task<std::optional<Problem>> explain_question(Command question, std::string caller);
  // Fails with not_excited and other known obstacles to a motion. They are read again, since somebody may have fixed
  // them.
  Task<Result<void>> check_excitation(AxisSet axes, std::string caller);

 private:
  Problem values_refused() const;
  Task<std::optional<Problem>> refusal_by_program(Command command, std::string caller);
  Task<std::optional<Problem>> refusal_by_settings(Command command, AxisSet axes, std::string caller);
  Task<std::optional<Problem>> refusal_by_stage(AxisSet axes, std::string caller);
  std::optional<Problem> refusal_by_speeds(const Command& command, const std::string& caller) const;
  Task<std::optional<Problem>> wrong_mode(std::string caller);
  Task<bool> sleeps(std::string caller);

  Dialogue& dialogue_;
  Reader& reader_;
  const Line& line_;
  const StateStore& store_;
  const Registers& registers_;
  const NonHost& non_host_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
