// The calls of one connection that the front answers itself. No I/O, no threads.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/front/call_filter.h"
#include "server/front/headers.h"
#include "server/front/holding.h"
#include "server/front/http2_session.h"

namespace axisgate::front {

class OwnCalls {
 public:
  // Called from any thread when pull() has something to fetch.
  using OnAnswer = std::function<void(StreamId stream)>;

  // The referenced objects must outlive this one.
  OwnCalls(CallFilter& filter, const Peer& peer, HeldBytes& held, Http2Session& client, OnAnswer on_answer)
      : filter_(filter), peer_(peer), held_(held), client_(client), on_answer_(std::move(on_answer)) {}

  bool has(StreamId stream) const { return calls_.contains(stream); }

  void begin(StreamId stream, Headers headers);
  // Takes a piece of the request. Returns a refusal if it cannot be taken.
  std::optional<Reply> take(StreamId stream, std::string_view bytes);
  // Called when the request is complete; asks the filter.
  void ask(StreamId stream);
  // Removes a call that its caller has left or that has been answered.
  void forget(StreamId stream) { calls_.erase(stream); }

  // Sends the filter's replies. Does nothing if the call has gone.
  void pull(StreamId stream);

 private:
  struct Call {
    Headers headers;
    Holding holding;
    std::string request{};
    std::unique_ptr<Answer> answer{};
    bool begun = false;  // the head of the answer has been sent
  };

  CallFilter& filter_;
  const Peer& peer_;
  HeldBytes& held_;
  Http2Session& client_;
  const OnAnswer on_answer_;
  std::map<StreamId, Call> calls_;
};

}  // namespace axisgate::front
