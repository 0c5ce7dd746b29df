// Who decides about a call by its headers, and answers those that gRPC shall not see. The front itself knows no method
// and no caller.
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

// The headers that name the caller, and Peer::source, to gRPC. A client's own are dropped.
inline constexpr const char* kCallerHeader = "axisgate-caller";
inline constexpr const char* kSourceHeader = "axisgate-source";

// Who is at the other end of a connection, as far as that is known without a token.
struct Peer {
  std::string who{};         // "unix alice", "cert alice", "tcp 127.0.0.1:39482"
  std::string source{};      // by whose budget it counts: "uid 1000", an address, a certificate
  bool needs_token = false;  // without a token nobody may call so
};

// The front gives these of gRPC's codes by itself.
inline constexpr int kInvalidArgument = 3, kDeadlineExceeded = 4, kResourceExhausted = 8, kUnimplemented = 12;

// What is sent to a caller: a message, the end, or both. A call with one answer has one of these.
struct Reply {
  int code = 0;                           // gRPC's; 0 is OK
  std::string message{};                  // for people, where it is not OK
  std::string details{};                  // of grpc-status-details-bin; empty: none
  std::optional<std::string> body{};      // a message of the answer
  bool last = true;                       // the call ends with it; otherwise its code says nothing
  std::optional<Duration> retry_after{};  // where it was refused for a while only
};

// The answer to one call, on the front's thread. It goes when it has ended, or when its caller has left it.
class Answer {
 public:
  virtual ~Answer() = default;
  // What has come since the last time, in order.
  virtual std::vector<Reply> take() = 0;
};

struct Verdict {
  enum class What {
    forward,  // gRPC's
    answer,   // Desk::answer()
    refuse,
  };
  What what = What::refuse;
  Reply refusal{};
  // Without the right, or of no method that there is. Such calls have a budget of their own, and do not count as the
  // caller's admission.
  bool unwanted = false;
  std::shared_ptr<void> place{};  // given back when the call has ended
  std::string path{};             // of a call to forward: its ":path" for gRPC
  // It counts in no limit of its caller, as a stop does: the front bounds how many are open, and how long they are.
  bool uncounted = false;
  // Who was let in by a name of their own, "token alice": whatever connections this caller has, from wherever, share
  // one budget. Empty: whom nothing names.
  std::string caller{};
};

// Called on the front's thread.
class Desk {
 public:
  virtual ~Desk() = default;

  // `stops_only`: the connection is one of the reserve.
  virtual Verdict judge(const Headers& headers, const Peer& peer, bool stops_only) = 0;

  // For a call that gRPC cannot be reached for, because no descriptors are free.
  virtual Reply no_room() = 0;

  // `message` is that of the whole request; nothing, if the request is not one message. `wake` is called from any
  // thread, perhaps from within this and after the answer has gone, whenever take() has something.
  virtual std::unique_ptr<Answer> answer(const Headers& headers, const Peer& peer,
                                         std::optional<std::string_view> message, std::function<void()> wake) = 0;
};

}  // namespace axisgate::front
