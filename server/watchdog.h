// Says that the daemon runs only if each of its threads does. A thread that hangs leaves no other trace: connections
// are accepted, and nothing moves or stops.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "device/core/time.h"

namespace axisgate::server {

class Watchdog {
 public:
  // One that is asked whether it runs.
  struct Thread {
    std::string name;  // for the log: "the thread of the lines"
    // Calls `answer` on that thread, soon. It may be called after the watchdog has gone.
    std::function<void(std::function<void()> answer)> ask;
  };
  // Calls the task once when that time has passed, perhaps after this has gone.
  using Later = std::function<void(Duration, std::function<void()>)>;

  // Asks all of them each `period`, and calls `alive` when all have answered. While one is silent nobody is asked
  // again, and the log names it once.
  Watchdog(std::vector<Thread> threads, Duration period, Later later, std::function<void()> alive);
  // Nothing is called any more. Waits while threads are asked.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  class Rounds;

  const std::shared_ptr<Rounds> rounds_;
};

}  // namespace axisgate::server
