// Answers of the API in the form in which the front sends them.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "server/api/request/call.h"
#include "server/api/request/subscription.h"
#include "server/front/call_filter.h"
#include "server/rpc/calls/served.h"

namespace axisgate::rpc {

using Wake = std::function<void()>;

// An answer with one reply, which may come from any thread.
class OneAnswer final : public front::Answer {
 public:
  // A Slot keeps the reply until take(). It may outlive the answer.
  class Slot {
   public:
    explicit Slot(Wake wake) : wake_(std::move(wake)) {}

    void leave(front::Reply reply) {
      {
        const std::lock_guard lock(mutex_);
        reply_ = std::move(reply);
      }
      wake_();
    }
    std::optional<front::Reply> take() {
      const std::lock_guard lock(mutex_);
      return std::exchange(reply_, std::nullopt);
    }

   private:
    std::mutex mutex_;
    std::optional<front::Reply> reply_;
    const Wake wake_;
  };

  explicit OneAnswer(std::shared_ptr<Slot> slot) : slot_(std::move(slot)) {}

  std::vector<front::Reply> take() override {
    std::vector<front::Reply> replies;
    if (auto reply = slot_->take()) replies.push_back(*std::move(reply));
    return replies;
  }

 private:
  const std::shared_ptr<Slot> slot_;
};

// Calls `ask` with the receiver of the outcome; `fill` makes the message from the outcome.
//    void ask(api::Answer<Outcome>)
template <class Outcome, class Fill, class Ask>
std::unique_ptr<front::Answer> one_answer(std::shared_ptr<Served> served, Wake wake, Fill fill, Ask ask) {
  const auto slot = std::make_shared<OneAnswer::Slot>(std::move(wake));
  ask(api::Answer<Outcome>([slot, served = std::move(served), fill = std::move(fill)](const Result<Outcome>& outcome) {
    slot->leave(outcome ? served->answered(fill(*outcome).SerializeAsString()) : served->refused(outcome.error()));
  }));
  return std::make_unique<OneAnswer>(slot);
}

// An answer whose reply is known at once.
inline std::unique_ptr<front::Answer> answer_now(front::Reply reply, Wake wake) {
  const auto slot = std::make_shared<OneAnswer::Slot>(std::move(wake));
  slot->leave(std::move(reply));
  return std::make_unique<OneAnswer>(slot);
}

// An answer with one message for each item of a subscription.
template <class Item, class Fill>
class StreamAnswer final : public front::Answer {
 public:
  StreamAnswer(std::shared_ptr<api::Subscription<Item>> subscription, std::shared_ptr<Served> served, Fill fill,
               Wake wake)
      : subscription_(std::move(subscription)), served_(std::move(served)), fill_(std::move(fill)) {
    subscription_->open(std::move(wake));
  }
  ~StreamAnswer() override { subscription_->close(); }
  StreamAnswer(const StreamAnswer&) = delete;
  StreamAnswer& operator=(const StreamAnswer&) = delete;

  std::vector<front::Reply> take() override {
    std::vector<front::Reply> replies;
    while (!ended_) {
      const auto reading = subscription_->next();
      if (std::holds_alternative<typename api::Subscription<Item>::Nothing>(reading)) break;
      const auto* end = std::get_if<api::StreamEnd>(&reading);
      ended_ = end != nullptr;
      replies.push_back(end ? served_->ended(*end) : message(std::get<Item>(reading)));
    }
    return replies;
  }

 private:
  front::Reply message(const Item& item) { return {.body = fill_(item).SerializeAsString(), .last = false}; }

  const std::shared_ptr<api::Subscription<Item>> subscription_;
  const std::shared_ptr<Served> served_;
  const Fill fill_;
  bool ended_ = false;
};

// A null subscription gives an empty stream that ends at once.
template <class Item, class Fill>
std::unique_ptr<front::Answer> stream_answer(const api::Opened<Item>& subscription, std::shared_ptr<Served> served,
                                             Fill fill, Wake wake) {
  if (!subscription) return answer_now(served->refused(subscription.error()), std::move(wake));
  if (*subscription == nullptr) return answer_now(served->ended({}), std::move(wake));
  return std::make_unique<StreamAnswer<Item, Fill>>(*subscription, std::move(served), std::move(fill), std::move(wake));
}

}  // namespace axisgate::rpc
