// Clearing of errors by BEC: (manual 53)), on request only: limit, overflow and emergency errors, and the BUSY that
// they report.
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

  // Clears the errors of the axes, or of all if `axes` is empty. Only for all axes, the latch of an emergency stop is
  // lifted once the controller reports no axis in emergency stop (bit 6 of manual 5)). Fails with link_down,
  // wrong_mode, device_refused, or a refusal of Rights; with stop_unconfirmed while an emergency stop is open.
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
