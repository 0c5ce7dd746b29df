// One item of a subscription, as the answer to a request with one answer.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "device/core/time.h"
#include "server/api/request/call.h"
#include "server/api/request/subscription.h"
#include "server/events/timeouts.h"

namespace axisgate::api {

// An Awaited reads a subscription until a wanted item comes, the subscription ends, the time is over or the caller has
// left. It then answers with the problem of the subscription, or without one with the newest item. Thread safe.
template <class Item>
class Awaited : public std::enable_shared_from_this<Awaited<Item>> {
 public:
  using Wanted = std::function<bool(const Item&)>;
  using Found = std::optional<Item>;  // nullopt: the subscription ended without an item
  using Handle = std::shared_ptr<Awaited>;

  static Handle start(std::shared_ptr<Subscription<Item>> subscription, Wanted wanted, Answer<Found> answer) {
    const Handle awaited(new Awaited(std::move(subscription), std::move(wanted), std::move(answer)));
    awaited->self_ = awaited;
    awaited->subscription_->open([waiting = std::weak_ptr(awaited)] {
      if (const auto still = waiting.lock()) still->read();
    });
    awaited->opened();
    return awaited;
  }

  // Answers after `wait` with the newest item, or then with the first one that comes.
  void limit(server::Timeouts& timeouts, Duration wait) {
    auto timeout = timeouts.unless_dropped(wait, [waiting = this->weak_from_this()] {
      if (const auto still = waiting.lock()) still->hurry();
    });
    const std::lock_guard lock(mutex_);
    if (self_) timeout_ = std::move(timeout);
  }

  // Ends the wait of a caller that has left, without an answer.
  void leave() { (void)end(); }

 private:
  // Allows reading. A wake-up before this reads nothing, because it could close the subscription while it is being
  // opened.
  void opened() {
    {
      const std::lock_guard lock(mutex_);
      opened_ = true;
    }
    read();
  }

  Awaited(std::shared_ptr<Subscription<Item>> subscription, Wanted wanted, Answer<Found> answer)
      : subscription_(std::move(subscription)), wanted_(std::move(wanted)), answer_(std::move(answer)) {}

  void read() {
    {
      const std::lock_guard lock(mutex_);
      if (!opened_) return;
    }
    {
      const std::lock_guard lock(reading_);
      if (!read_all()) return;
    }
    finish();
  }

  // Returns true once there is an answer.
  bool read_all() {
    while (true) {
      auto reading = subscription_->next();
      const std::lock_guard lock(mutex_);
      if (!self_) return false;
      if (auto* item = std::get_if<Item>(&reading)) {
        newest_ = std::move(*item);
        if (hurried_ || wanted_(*newest_)) return true;
      } else if (const auto* end = std::get_if<StreamEnd>(&reading)) {
        if (end->problem) problem_ = end->problem;
        return true;
      } else {
        return false;
      }
    }
  }

  void hurry() {
    {
      const std::lock_guard lock(mutex_);
      hurried_ = true;
      if (!newest_) return;
    }
    finish();
  }

  void finish() {
    if (!end()) return;
    if (problem_) return answer_(tl::unexpected(*problem_));
    answer_(std::move(newest_));
  }

  // Returns false if it has ended before. No lock is held while the subscription closes: closing waits for a wake-up in
  // progress, which takes both locks.
  bool end() {
    Handle self;
    std::unique_ptr<server::Timeout> timeout;
    {
      const std::lock_guard lock(mutex_);
      self = std::exchange(self_, nullptr);
      timeout = std::move(timeout_);
    }
    if (!self) return false;
    subscription_->close();
    return true;
  }

  const std::shared_ptr<Subscription<Item>> subscription_;
  const Wanted wanted_;
  const Answer<Found> answer_;
  std::mutex reading_;  // one thread reads at a time
  std::mutex mutex_;    // guards the members below
  bool opened_ = false;
  Found newest_;
  bool hurried_ = false;  // any item is wanted
  std::optional<Problem> problem_;
  std::unique_ptr<server::Timeout> timeout_;
  Handle self_;  // keeps this object until the answer; null after it
};

}  // namespace axisgate::api
