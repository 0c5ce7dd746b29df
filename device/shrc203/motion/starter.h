// Setting and starting: a setpoint is written until it has certainly arrived, a start only once, whatever becomes of
// its reply.
#pragma once

#include <optional>

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/explainer.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/registers.h"

namespace axisgate::shrc203 {

// Result of a start that was not refused.
enum class Start { accepted, in_doubt };

class Starter {
 public:
  Starter(Dialogue& dialogue, Reader& reader, Explainer& explainer, const StateStore& store, Motions& motions,
          Tasks& tasks)
      : dialogue_(dialogue), reader_(reader), explainer_(explainer), store_(store), motions_(motions), tasks_(tasks) {}

  // Writes a setpoint. A setpoint starts nothing, so it is read back if its reply was lost, and sent again if it did
  // not arrive.
  Task<Result<Reply>> set_and_confirm(LiveMotionPtr live, Command setter, Lane lane);
  // Sends G:. `completes` are the axes whose completions will arrive.
  Task<Result<Start>> go(LiveMotionPtr live, AxisSet completes);
  // Sends a line that starts a motion without G:; each axis then reports its end. Returns nullopt if the motion has its
  // outcome.
  Task<std::optional<Start>> start(LiveMotionPtr live, Command command);
  // Reports whether the start has certainly not arrived: a start that arrived has taken the setpoint out of its
  // register.
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
