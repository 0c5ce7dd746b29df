// One reader's stream: of a device's state, a motion, leases, events, a recording ... All streams of all doors are
// subscriptions.
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

// How a stream ends.
struct StreamEnd {
  std::optional<Problem> problem{};       // nothing: in order
  std::optional<std::uint64_t> resume{};  // with compacted: the oldest revision that can be had
};

// Pulled by its reader: next() is called when the item before has been taken, so nothing queues up for a slow one. Held
// by shared pointers, since a timer or a device's answer may come after the reader has gone. Thread safe.
template <class Item>
class Subscription : public std::enable_shared_from_this<Subscription<Item>> {
 public:
  struct Nothing {};  // before `wake` is called
  using Reading = std::variant<Nothing, Item, StreamEnd>;

  virtual ~Subscription() = default;

  // Once, before the first next(). `wake` is called from any thread whenever next() may have something new, perhaps
  // once for many items, at the latest when this object goes; it may call next(). It must not hold this object.
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

  // The next item, the end, or nothing before `wake` is called. Nothing follows the end.
  Reading next() {
    const std::lock_guard lock(mutex_);
    const auto cut = place_ ? place_->cut_off() : std::nullopt;
    if (cut && !cut->after_what_is_due) return StreamEnd{cut->why};
    Reading reading = read();
    if (cut && std::holds_alternative<Nothing>(reading)) return StreamEnd{cut->why};
    return reading;
  }

  // Its caller has gone without a word, or may not continue: what must not continue without its caller ends.
  virtual void break_off() {}

  // The reader has gone, in order or not. Once; no wake-up from the gateway's side comes after it has returned.
  void close() {
    wake_up_.reset();
    left();
  }

 protected:
  explicit Subscription(Streams::Place place) : place_(std::move(place)) {}

  // What wakes it is arranged here: open() has been called.
  virtual void begin() = 0;
  // Called under mutex_.
  virtual Reading read() = 0;
  virtual void left() {}

  // Not under mutex_.
  void wake() const { wake_(); }

  // `source` is anything with subscribe(): it wakes the reader from now on.
  template <class Source>
  void woken_by(Source& source) {
    wake_up_ = source.subscribe([this] { wake(); });
  }

  // A shared pointer to the whole object.
  template <class Derived>
  std::shared_ptr<Derived> self() {
    return std::static_pointer_cast<Derived>(this->shared_from_this());
  }

  std::mutex mutex_;  // of the derived class's state

 private:
  const Streams::Place place_;
  std::function<void()> wake_;
  std::unique_ptr<server::WakeUps::Subscription> wake_up_;
};

// A stream, or why there is none.
template <class Item>
using Opened = Result<std::shared_ptr<Subscription<Item>>>;

}  // namespace axisgate::api
