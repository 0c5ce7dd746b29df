// BEC: (manual 53)), on request only: it clears limit, overflow and emergency errors, and what they say of BUSY.
#pragma once

#include <string>

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/open_stops.h"
#include "device/shrc203/state/rights.h"
#include "device/shrc203/state/state_store.h"
#include "device/stage/stage_controller.h"

namespace axisgate::shrc203 {

class ErrorClearing {
 public:
  ErrorClearing(Dialogue& dialogue, Reader& reader, StateStore& store, OpenStops& open_stops, Rights& rights,
                const NonHost& non_host, Tasks& tasks)
      : dialogue_(dialogue),
        reader_(reader),
        store_(store),
        open_stops_(open_stops),
        rights_(rights),
        non_host_(non_host),
        tasks_(tasks) {}

  // No axes: all. Only for all axes it lifts the latch of an emergency stop, once the controller reports none of them
  // in emergency stop (bit 6 of manual 5)). Fails with link_down, wrong_mode, what Rights refuse, device_refused;
  // stop_unconfirmed while an emergency stop is open.
  void clear(AxisSet axes, RequestContext context, StageController::OnDone done);

 private:
  Task<void> run(AxisSet axes, RequestContext context, StageController::OnDone done);
  Result<AxisSet> check(AxisSet axes, const RequestContext& context);
  bool lifts_latch(AxisSet axes) const;
  Result<void> lift_latch(AxisSet axes, const std::string& who);

  Dialogue& dialogue_;
  Reader& reader_;
  StateStore& store_;
  OpenStops& open_stops_;
  Rights& rights_;
  const NonHost& non_host_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
