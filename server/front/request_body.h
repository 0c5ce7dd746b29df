// The messages in the body of one request, as gRPC's protocol packs them: a flag, a length, and the message. What a
// client has compressed is unpacked here, in pieces and within bounds, since gRPC 1.51 unpacks all of a message before
// it looks at its size.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "server/front/desk.h"
#include "server/front/holding.h"

namespace axisgate::front {

// Not thread safe.
class RequestBody {
 public:
  // `encoding` is the call's grpc-encoding; empty: none. `all` outlives it.
  RequestBody(std::string_view encoding, std::size_t message_bytes, HeldBytes& all);

  // Appends to `out` what is passed on of these bytes: messages that are not compressed. The answer to the call, where
  // they cannot be taken.
  std::optional<Reply> take(std::string_view bytes, std::string& out);
  // What take() gave out is accounted for elsewhere from now on.
  void passed_on() { unpacked_.give_back(std::exchange(given_out_, 0)); }

  // A message has begun, and is not whole.
  bool unfinished() const { return !prefix_.empty(); }
  // Bytes that came out of compressed messages since the last time.
  std::size_t take_cost() { return std::exchange(cost_, 0); }

 private:
  struct Inflater {
    Inflater();
    ~Inflater();
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    z_stream stream{};
    bool ended = false;
  };

  std::optional<Reply> begin_message();
  std::optional<Reply> unpack(std::string_view packed);
  std::optional<Reply> end_message(std::string& out);

  const bool unpacks_;  // gzip or deflate
  const std::string unknown_encoding_;
  const std::size_t message_bytes_;
  std::string prefix_;                  // of the message that has begun
  std::size_t left_ = 0;                // of this message
  std::unique_ptr<Inflater> inflater_;  // while it is a compressed one
  std::string message_;                 // what has been unpacked of it
  Holding unpacked_;                    // that, and messages that were given out
  std::size_t given_out_ = 0;
  std::size_t cost_ = 0;
};

// A message as a body carries it.
std::string with_prefix(std::string_view message);
// The message of a body that holds one, not compressed; nothing if it holds none, or more.
std::optional<std::string_view> only_message(std::string_view body);

}  // namespace axisgate::front
