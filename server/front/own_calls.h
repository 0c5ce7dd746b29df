// The calls of one connection that the front answers itself: their requests as they come in, and their answers as the
// client's flow control lets them out (RFC 9113, 5.2). No I/O, no threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "server/front/desk.h"
#include "server/front/frames.h"
#include "server/front/header_codec.h"
#include "server/front/limits.h"

namespace axisgate::front {

class OwnCalls {
 public:
  // Called from any thread when pull() has something to fetch.
  using OnAnswer = std::function<void(std::uint32_t stream)>;

  // `desk`, `limits` and `peer` outlive it.
  OwnCalls(Desk& desk, const FrontLimits& limits, const Peer& peer, OnAnswer on_answer)
      : desk_(desk), limits_(limits), peer_(peer), on_answer_(std::move(on_answer)) {}

  std::size_t size() const { return calls_.size(); }
  bool has(std::uint32_t stream) const { return calls_.contains(stream); }
  // False: too many that nobody counts, or too long requests together, are open.
  bool within_limits() const;

  // `place`: that of the call in the limits of its caller; null where it is in none.
  void begin(std::uint32_t stream, Headers headers, std::shared_ptr<void> place);
  // A piece of its request. A refusal, if it cannot be taken: then the call is forgotten.
  std::optional<Reply> take(std::uint32_t stream, std::string_view content);
  // The request is whole: the desk is asked. Likewise.
  std::optional<Reply> ask(std::uint32_t stream);
  // Its caller has left it.
  void forget(std::uint32_t stream);

  // Fetches what the desk has. Nothing, if the call has gone.
  void pull(std::uint32_t stream);

  // What the client lets each call receive.
  void set_first_window(std::int64_t bytes);
  // False: more than there can be.
  bool widen(std::uint32_t stream, std::int64_t bytes);

  // Whole frames of answers, with at most `window` bytes of messages, which are taken off it.
  std::string frames(std::int64_t& window);

 private:
  struct Call {
    Headers headers;
    std::shared_ptr<void> place;
    std::string request;
    bool asked = false;
    std::unique_ptr<Answer> answer;
    std::int64_t window = 0;
    std::string head;                   // not sent yet
    bool begun = false;                 // it has been made
    std::string messages;               // not sent yet
    std::optional<std::string> ending;  // goes behind them
  };

  Reply refused(std::uint32_t stream, int code, std::string why);
  bool send(std::uint32_t stream, Call& call, std::int64_t& window, std::string& out);

  Desk& desk_;
  const FrontLimits& limits_;
  const Peer& peer_;
  const OnAnswer on_answer_;
  std::int64_t first_window_ = kFirstWindow;
  std::size_t requests_bytes_ = 0;  // of all that are not whole
  std::map<std::uint32_t, Call> calls_;
  std::set<std::uint32_t> due_;  // those with something to send
};

}  // namespace axisgate::front
