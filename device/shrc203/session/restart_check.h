// Whether the controller has restarted behind an answer that came late or after a pause.
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

  // Confirms the controller to the line, or gives the line up. Ends where another connection has come.
  Task<void> run(std::uint64_t connection);

 private:
  bool anywhere_but_zero() const;
  bool still_at(const Positions& before) const;  // an axis shows the nonzero position that was known before
  // False where no answer made sense in several attempts, or another connection has come.
  Task<bool> read_positions(std::uint64_t connection);

  Dialogue& dialogue_;
  Line& line_;
  Reader& reader_;
  const StateStore& store_;
  const Tasks& tasks_;
};

}  // namespace axisgate::shrc203
