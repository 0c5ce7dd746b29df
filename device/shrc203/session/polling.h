// Polling, which keeps the state current and detects motion ends whose completion was lost. Slow while nothing moves.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "device/core/tasks.h"
#include "device/shrc203/session/reader.h"
#include "device/shrc203/state/motions.h"
#include "device/shrc203/state/non_host.h"
#include "device/shrc203/state/state_store.h"

namespace axisgate::shrc203 {

class Polling {
 public:
  // `watched` reports whether a procedure already reads the positions at the same pace.
  Polling(Reader& reader, StateStore& store, Motions& motions, const NonHost& non_host, Tasks& tasks,
          std::function<bool()> watched);

  // Passes on the state, which is read again if it is older than `max_age`. Fails with wrong_mode or link_down.
  void refresh(Duration max_age, RequestContext context, StageController::OnState done);

 private:
  Duration interval() const;
  Task<void> poll();
  bool positions_due() const;
  bool excitation_due() const;
  Task<void> read_for(Duration max_age, RequestContext context, StageController::OnState done);
  bool is_fresh(Duration max_age) const;
  Task<void> join(Duration max_age);
  Task<Result<void>> read_now(std::string caller);

  Reader& reader_;
  StateStore& store_;
  Motions& motions_;
  const NonHost& non_host_;
  Tasks& tasks_;
  std::function<bool()> watched_;
  std::optional<TimePoint> reading_since_;  // time of the newest unanswered question for a caller
  Signal reading_ended_;
};

}  // namespace axisgate::shrc203
