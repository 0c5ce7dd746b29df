// BEC: (manual 53)), on request only: it clears limit, overflow and emergency errors, and what they say of BUSY.
#pragma once

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/rights.h"
#include "device/shrc203/state/state_store.h"
#include "device/stage/stage_controller.h"

namespace axisgate::shrc203 {

class ErrorClearing {
 public:
  ErrorClearing(Dialogue& dialogue, Reader& reader, StateStore& store, Rights& rights, const NonHost& non_host,
                Tasks& tasks)
      : dialogue_(dialogue), reader_(reader), store_(store), rights_(rights), non_host_(non_host), tasks_(tasks) {}

  // No axes: all. link_down, wrong_mode, what Rights refuse, device_refused.
  void clear(AxisSet axes, RequestContext context, StageController::OnDone done);

 private:
  Task<void> run(AxisSet axes, RequestContext context, StageController::OnDone done);

  Dialogue& dialogue_;
  Reader& reader_;
  StateStore& store_;
  Rights& rights_;
  const NonHost& non_host_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
