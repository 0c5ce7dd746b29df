// Check whether the controller has restarted, after a late reply or a pause.
#pragma once

#include <cstdint>

#include "device/core/tasks.h"
#include "device/shrc203/planning/plan.h"
#include "device/shrc203/session/dialogue.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class RestartCheck {
 public:
  RestartCheck(Dialogue& dialogue, Line& line, Reader& reader, const StateStore& store, const Tasks& tasks)
      : dialogue_(dialogue), line_(line), reader_(reader), store_(store), tasks_(tasks) {}

  // Confirms to the line that there was no restart, or disconnects. Ends early if another connection has begun.
  Task<void> run(std::uint64_t connection);

 private:
  bool anywhere_but_zero() const;
  bool still_at(const Positions& before) const;  // whether an axis still has its nonzero position
  // Returns false if no attempt gave a sensible reply, or another connection has begun.
  Task<bool> read_positions(std::uint64_t connection);

  Dialogue& dialogue_;
  Line& line_;
  Reader& reader_;
  const StateStore& store_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
