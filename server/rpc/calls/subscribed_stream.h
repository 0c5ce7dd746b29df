// A subscription of the API as a stream of messages.
#pragma once

#include <grpcpp/support/server_callback.h>

#include <functional>
#include <memory>
#include <utility>
#include <variant>

#include "server/api/request/subscription.h"
#include "server/rpc/calls/ended_stream.h"
#include "server/rpc/calls/pull_stream.h"
#include "server/rpc/calls/status.h"

namespace axisgate::rpc {

// Each item of the subscription becomes one message. PullStream describes `Reactor`.
template <class Reactor, class Response, class Item>
class SubscribedStream : public PullStream<Reactor, Response> {
 public:
  using Fill = std::function<void(Response&, const Item&)>;

  SubscribedStream(std::shared_ptr<api::Subscription<Item>> subscription, Fill fill)
      : subscription_(std::move(subscription)), fill_(std::move(fill)) {}

  // Starts the stream. Call it after construction.
  void serve() {
    this->open();
    // The subscription may outlive the stream, so it keeps a weak pointer only.
    subscription_->open([stream = this->weak_from_this()] {
      if (const auto still = stream.lock()) still->pump();
    });
  }

 protected:
  using Next = typename PullStream<Reactor, Response>::Next;
  using Wait = typename PullStream<Reactor, Response>::Wait;

  Next next() override {
    using Subscription = api::Subscription<Item>;
    const typename Subscription::Reading reading = subscription_->next();
    if (const auto* end = std::get_if<api::StreamEnd>(&reading)) return to_status(*end);
    const auto* item = std::get_if<Item>(&reading);
    if (item == nullptr) return Wait{};
    Response response;
    fill_(response, *item);
    return response;
  }

  void closed() override { subscription_->close(); }

 private:
  const std::shared_ptr<api::Subscription<Item>> subscription_;
  const Fill fill_;
};

// Serves a subscription to a call with one request. A null subscription gives an empty stream that ends with OK.
template <class Response, class Item, class Fill>
grpc::ServerWriteReactor<Response>* serve(api::Opened<Item> subscription, Fill fill) {
  using Reactor = grpc::ServerWriteReactor<Response>;
  using Stream = SubscribedStream<Reactor, Response, Item>;
  if (!subscription) return new EndedStream<Reactor>(subscription.error());
  if (*subscription == nullptr) return new EndedStream<Reactor>(grpc::Status::OK);
  const auto stream = std::make_shared<Stream>(*std::move(subscription), std::move(fill));
  stream->serve();
  return stream.get();
}

}  // namespace axisgate::rpc
