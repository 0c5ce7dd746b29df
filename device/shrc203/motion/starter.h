// Set and go: a setpoint is written until it is certain that it arrived, and a start once, whatever becomes of its
// answer.
#pragma once

#include <optional>

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/registers.h"

namespace axisgate::shrc203 {

// What became of a start that was not refused.
enum class Start { accepted, in_doubt };

class Starter {
 public:
  Starter(Dialogue& dialogue, Reader& reader, Explainer& explainer, const StateStore& store, Motions& motions,
          Tasks& tasks)
      : dialogue_(dialogue), reader_(reader), explainer_(explainer), store_(store), motions_(motions), tasks_(tasks) {}

  // A setpoint starts nothing, so one whose answer was lost is read back, and sent again when it did not arrive.
  Task<Result<Reply>> set_and_confirm(LiveMotionPtr live, Command setter, Lane lane);
  // `completes` are the axes whose numbers will come.
  Task<Result<Start>> go(LiveMotionPtr live, AxisSet completes);
  // A line that starts by itself, and after which each axis reports its end. Nothing: the motion has its outcome.
  Task<std::optional<Start>> start(LiveMotionPtr live, Command command);
  // A start that arrived has taken the setpoint out of its register. True only when it is certain that none did.
  Task<bool> start_never_came(LiveMotionPtr live, Command setter);
  static Problem never_came(const LiveMotion& live);

 private:
  Task<std::optional<Held>> read_back(LiveMotionPtr live, Command setter, Lane lane);
  Task<bool> moves_despite_ng(LiveMotionPtr live);
  bool anything_changed(const LiveMotion& live, const Positions& before) const;

  Dialogue& dialogue_;
  Reader& reader_;
  Explainer& explainer_;
  const StateStore& store_;
  Motions& motions_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
