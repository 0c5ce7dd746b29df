// Signs of life of the daemon, which depend on an answer from each of its threads. If a thread hangs, connections are
// still accepted, but motions neither start nor stop, and no other sign shows it.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "device/core/time.h"

namespace axisgate::server {

class Watchdog {
 public:
  // One thread to watch.
  struct Thread {
    std::string name;  // for the log: "the thread of the lines"
    // Calls `answer` on the thread soon, possibly after the watchdog has gone.
    std::function<void(std::function<void()> answer)> ask;
  };
  // Calls the task once after the given time, possibly after the watchdog has gone.
  using Later = std::function<void(Duration, std::function<void()>)>;

  // Asks all threads each `period`, and calls `alive` when all have answered. While a thread is silent, no thread is
  // asked again, and the log names the silent thread once.
  Watchdog(std::vector<Thread> threads, Duration period, Later later, std::function<void()> alive);
  // No callback runs after this returns. Waits while threads are being asked.
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  class Rounds;

  const std::shared_ptr<Rounds> rounds_;
};

}  // namespace axisgate::server
