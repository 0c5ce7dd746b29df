// What the front panel decides: the controller's mode and dialect. Neither is ever switched back from here.
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

  // A refused Q: means that somebody has changed the mode or the dialect: if so, the gateway disconnects.
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
