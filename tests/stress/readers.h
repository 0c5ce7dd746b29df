// Readers of facts, quick and slow, and of the newest states; and publishers of facts for them.
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

// A QuickReader reads whenever it is woken, as a stream does, and never falls behind. It expects every revision once
// and in order, and one outcome for each motion with nothing after it.
class QuickReader {
 public:
  explicit QuickReader(server::EventBus& bus);

  std::uint64_t next() const { return next_; }
  // Waits until every motion that began has its outcome. Returns false if that takes more than a minute.
  [[nodiscard]] bool wait_until_all_ended() const;

 private:
  void read();
  void follow(const server::FactRecord& record);

  server::EventBus& bus_;
  std::atomic<std::uint64_t> next_ = 1;
  std::atomic<std::uint64_t> motions_open_ = 0;
  std::map<std::pair<std::string, stage::MotionId>, stage::MotionState> motions_;
  std::unique_ptr<server::WakeUps::Subscription>
      subscription_;  // last member, so that it is destroyed before the members that its callback uses
};

// A StateReader reads a state whenever it is woken, and expects neither an older state nor the state of another device.
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

// Reads slowly until `ended`; runs on a separate thread. Lets more facts pass than are kept, is notified of the loss,
// and then continues without a gap. Returns the number of notifications.
int read_slowly(server::EventBus& bus, const std::atomic<bool>& ended);

// Publishes `facts` facts that belong to no device, in portions that `reader` can follow.
void publish_facts(server::EventBus& bus, const QuickReader& reader, int facts);

// Repeatedly subscribes, publishes and unsubscribes, and lets timers run.
void come_and_go(server::Gateway& gateway, int times);

}  // namespace axisgate::stress
