// Settings of the front panel: the controller's mode and dialect. The gateway never switches them back.
#pragma once

#include <cstdint>

#include "device/core/tasks.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class FrontPanel {
 public:
  FrontPanel(Dialogue& dialogue, Line& line, StateStore& store, const NonHost& non_host, Tasks& tasks)
      : dialogue_(dialogue), line_(line), store_(store), non_host_(non_host), tasks_(tasks) {}

  // Called after a refused Q:. Disconnects if somebody has changed the mode or the dialect.
  void position_refused() { tasks_.spawn(follow_mode()); }

 private:
  Task<void> follow_mode();

  Dialogue& dialogue_;
  Line& line_;
  StateStore& store_;
  const NonHost& non_host_;
  Tasks& tasks_;
};

}  // namespace axisgate::shrc203
