// End of the gateway: waiting motions are withdrawn, running ones are stopped or awaited, and the exchange in flight is
// finished.
#pragma once

#include <memory>

#include "device/core/tasks.h"
#include "device/shot/line/line.h"
#include "device/shrc203/session/ending.h"
#include "device/shrc203/session/restorer.h"
#include "device/shrc203/session/stops.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class WindDown {
 public:
  WindDown(Line& line, Stops& stops, Restorer& restorer, StateStore& store, Motions& motions, Ending& ending,
           Tasks& tasks)
      : line_(line),
        stops_(stops),
        restorer_(restorer),
        store_(store),
        motions_(motions),
        ending_(ending),
        tasks_(tasks) {}

  // Implements StageController::wind_down().
  Task<void> run(StageController::OnWoundDown done);

 private:
  using Report = std::shared_ptr<WindDownReport>;
  enum class Whom { unstarted, everybody };

  void stop(Whom whom, Report report);
  Task<void> wait_for_rest(TimePoint limit);
  Task<void> finish_line(bool stop_failed);

  Line& line_;
  Stops& stops_;
  Restorer& restorer_;
  StateStore& store_;
  Motions& motions_;
  Ending& ending_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
