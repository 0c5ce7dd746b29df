// Decides about a call by its headers, and answers the calls that must not pass through gRPC. The front itself knows
// neither methods nor callers.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/time.h"
#include "server/front/headers.h"

namespace axisgate::front {

// Headers that pass the caller and Peer::source on to gRPC. The client's own headers of these names are dropped.
inline constexpr const char* kCallerHeader = "axisgate-caller";
inline constexpr const char* kSourceHeader = "axisgate-source";

// A Peer is the other end of a connection, as far as it is known without a token.
struct Peer {
  std::string who{};         // "unix alice", "cert alice", "tcp 127.0.0.1:39482"
  std::string source{};      // owner of the budget: "uid 1000", an address, a certificate
  bool needs_token = false;  // calls without a token are refused
};

// gRPC's codes that the front itself returns.
inline constexpr int kInvalidArgument = 3, kDeadlineExceeded = 4, kResourceExhausted = 8, kUnimplemented = 12;

// A Reply is one part of an answer: a message, the end, or both. A call with one answer has one Reply.
struct Reply {
  int code = 0;                           // gRPC's; 0 is OK
  std::string message{};                  // for people; empty if the code is OK
  std::string details{};                  // value of grpc-status-details-bin; empty: none
  std::optional<std::string> body{};      // a message of the answer
  bool last = true;                       // ends the call; otherwise `code` has no meaning
  std::optional<Duration> retry_after{};  // set if the call was refused only for a while
};

// An Answer belongs to one call, on the front's thread. It is destroyed when it has ended or its caller has left.
class Answer {
 public:
  virtual ~Answer() = default;
  // Returns the replies that have come since the last call, in order.
  virtual std::vector<Reply> take() = 0;
};

struct Decision {
  enum class What {
    forward,  // to gRPC
    answer,   // by CallFilter::answer()
    refuse,
  };
  What what = What::refuse;
  Reply refusal{};
  // The caller lacks the right, or the method does not exist. Such calls have a separate budget, and do not admit the
  // caller.
  bool denied = false;
  std::shared_ptr<void> place{};  // released when the call has ended
  std::string path{};             // ":path" for gRPC if the call is forwarded
  // The call counts in no limit of its caller, such as a stop. The front bounds the number and the length of these
  // calls.
  bool uncounted = false;
  // Name of the admitted caller, such as "token alice". All connections of this caller, from any address, share one
  // budget. Empty: anonymous.
  std::string caller{};
};

// Called on the front's thread.
class CallFilter {
 public:
  virtual ~CallFilter() = default;

  // `stops_only`: only a stop may be let in, as on a connection of the reserve.
  virtual Decision decide(const Headers& headers, const Peer& peer, bool stops_only) = 0;

  // Returns the refusal for a call when gRPC cannot be reached because no descriptors are free.
  virtual Reply no_room() = 0;

  // `message` is the message of the whole request; nullopt if the request is not exactly one message. `wake` is called
  // whenever take() has something: from any thread, possibly within answer(), and possibly after the Answer has gone.
  virtual std::unique_ptr<Answer> answer(const Headers& headers, const Peer& peer,
                                         std::optional<std::string_view> message, std::function<void()> wake) = 0;
};

}  // namespace axisgate::front
