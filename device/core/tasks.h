// Shared parts of one machine's tasks: the present moment, the executor that resumes them, and pauses.
#pragma once

#include <optional>
#include <utility>

#include "device/core/task.h"
#include "device/core/time.h"

namespace axisgate {

// Runs on the strand of its machine, like the executor. Time never passes within one call.
class Tasks {
 public:
  TimePoint now() const { return now_; }
  void now_is(TimePoint now) { now_ = now; }

  Executor& executor() { return executor_; }
  void spawn(Task<void> task) { executor_.spawn(std::move(task)); }

  // Pause until a moment, or for a duration; co_await the result. A pause never ends early.
  OneShot<bool> until(TimePoint at) { return pauses_.wait_until(at); }
  OneShot<bool> pause(Duration duration) { return until(now_ + duration); }

 private:
  TimePoint now_{};
  Executor executor_;
  Signal pauses_{executor_};  // never notified
};

}  // namespace axisgate
