// Stream of one reader: states of a device, a motion, leases, events, a recording and so on. All streams of all doors
// are subscriptions.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>

#include "device/core/problem.h"
#include "server/api/request/streams.h"
#include "server/events/wake_ups.h"

namespace axisgate::api {

// A StreamEnd says how a stream ends.
struct StreamEnd {
  std::optional<Problem> problem{};       // nullopt: ended normally
  std::optional<std::uint64_t> resume{};  // with compacted: the oldest available revision
};

// A Subscription is pulled by its reader: next() is called when the item before was taken, so nothing queues up for a
// slow reader. Shared pointers keep it, because a timer or a device's answer may come after the reader has gone. Thread
// safe.
template <class Item>
class Subscription : public std::enable_shared_from_this<Subscription<Item>> {
 public:
  struct Nothing {};  // until `wake` is called
  using Reading = std::variant<Nothing, Item, StreamEnd>;

  virtual ~Subscription() = default;

  // Opens the stream; called once, before the first next(). `wake` is called from any thread whenever next() may return
  // something new, possibly once for many items, at the latest when this object is destroyed; it may call next(). It
  // must not keep this object alive.
  void open(std::function<void()> wake) {
    wake_ = std::move(wake);
    if (place_) {
      place_->on_cut_off([self = this->weak_from_this()] {
        const auto still = self.lock();
        if (!still) return;
        still->break_off();
        still->wake();
      });
    }
    begin();
  }

  // Returns the next item, the end, or Nothing until `wake` is called. No item follows the end.
  Reading next() {
    const std::lock_guard lock(mutex_);
    const auto cut = place_ ? place_->cut_off() : std::nullopt;
    if (cut && !cut->after_what_is_due) return StreamEnd{cut->why};
    Reading reading = read();
    if (cut && std::holds_alternative<Nothing>(reading)) return StreamEnd{cut->why};
    return reading;
  }

  // Called when the caller has disconnected without ending the stream, or may not continue. Ends everything that must
  // not continue without its caller.
  virtual void break_off() {}

  // Called once when the reader has gone, normally or not. No wake-up from the gateway comes after it returns.
  void close() {
    wake_up_.reset();
    left();
  }

 protected:
  explicit Subscription(Streams::Place place) : place_(std::move(place)) {}

  // Arranges the wake-ups. Called by open().
  virtual void begin() = 0;
  // Called under mutex_.
  virtual Reading read() = 0;
  virtual void left() {}

  // Must not be called under mutex_.
  void wake() const { wake_(); }

  // Lets `source`, any object with subscribe(), wake the reader from now on.
  template <class Source>
  void woken_by(Source& source) {
    wake_up_ = source.subscribe([this] { wake(); });
  }

  // Returns a shared pointer to the whole object.
  template <class Derived>
  std::shared_ptr<Derived> self() {
    return std::static_pointer_cast<Derived>(this->shared_from_this());
  }

  std::mutex mutex_;  // guards the state of the derived class

 private:
  const Streams::Place place_;
  std::function<void()> wake_;
  std::unique_ptr<server::WakeUps::Subscription> wake_up_;
};

// A stream, or the problem that prevented it.
template <class Item>
using Opened = Result<std::shared_ptr<Subscription<Item>>>;

}  // namespace axisgate::api
