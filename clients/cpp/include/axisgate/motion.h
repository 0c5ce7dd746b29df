// A motion that was started.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "axisgate/results.h"

namespace axisgate {

namespace client {
class MotionHandle;
}

// A Motion was started, and continues whatever this program does. Copies are the same motion. All functions are thread
// safe.
class AXISGATE_PUBLIC Motion {
 public:
  explicit Motion(std::shared_ptr<client::MotionHandle> handle) : handle_(std::move(handle)) {}

  std::string name() const;  // "devices/stage/motions/12"
  // Returns the state as last received: "QUEUED", "RUNNING", "STOPPING", "SUCCEEDED", "STOPPED", "FAILED" or "UNKNOWN".
  std::string state() const;
  std::string request_id() const;  // id of the request that started the motion

  // Reports whether the motion has its outcome. Asks the daemon if the outcome is not known yet.
  bool done() const;

  // Waits for the outcome, also over broken connections and restarts of the daemon. `stop` ends the waiting, not the
  // motion. Throws Stopped, MotionFailed or OutcomeUnknown unless the motion succeeds, and Interrupted after `stop`.
  MotionResult wait(std::stop_token stop = {}) const;
  // Does the same as wait() for a limited time. Returns nullopt if the motion has no outcome by then.
  std::optional<MotionResult> wait_for(std::chrono::milliseconds limit) const;

  // Calls `show` at each interval until the motion has its outcome, which wait() then returns.
  void follow(const std::function<void(const Progress&)>& show,
              std::chrono::milliseconds interval = std::chrono::milliseconds(200)) const;

  // Stops the motion, or drops it if it has not started. Has no effect on a motion with an outcome.
  void cancel() const;

 private:
  std::shared_ptr<client::MotionHandle> handle_;
};

}  // namespace axisgate
