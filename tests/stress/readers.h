// Those who only look: at the facts, quickly and slowly, at the newest states, at the metrics page.
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "server/events/event_bus.h"
#include "server/events/newest.h"
#include "tests/stress/bench.h"

namespace axisgate::stress {

// Reads whenever it is woken, as a stream does, and never falls behind: every revision once and in order, and of every
// motion one outcome with nothing after it.
class QuickReader {
 public:
  explicit QuickReader(server::EventBus& bus);

  std::uint64_t next() const { return next_; }
  // Until every motion that began has its outcome; false when that takes absurdly long.
  [[nodiscard]] bool wait_until_all_ended() const;

 private:
  void read();
  void follow(const server::FactRecord& record);

  server::EventBus& bus_;
  std::atomic<std::uint64_t> next_ = 1;
  std::atomic<std::uint64_t> motions_open_ = 0;
  std::map<std::pair<std::string, stage::MotionId>, stage::MotionState> motions_;
  std::unique_ptr<server::WakeUps::Subscription> subscription_;  // the last member: gone before what it wakes
};

// Every state that it is woken for: never an older one, never another device's.
class StateReader {
 public:
  StateReader(Bench& bench, std::size_t device);

 private:
  void read();

  server::Newest<stage::State>& states_;
  const std::size_t device_;
  std::uint64_t version_ = 0;
  std::unique_ptr<server::WakeUps::Subscription> subscription_;
};

// On a thread of its own, until `ended`: lets more pass by than is kept, is notified of it, and continues without a
// gap. Returns the number of notifications.
int read_slowly(server::EventBus& bus, const std::atomic<bool>& ended);

// Publishes so many facts of nobody's, in portions that `reader` can follow.
void publish_facts(server::EventBus& bus, const QuickReader& reader, int facts);

// Subscribes, publishes and leaves, again and again, and lets timers run.
void come_and_go(server::Gateway& gateway, int times);

}  // namespace axisgate::stress
