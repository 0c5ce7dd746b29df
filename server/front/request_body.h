// The messages in the body of one request, in gRPC's format: a flag, a length, and the message. Compressed messages are
// unpacked here, in pieces and within bounds, since gRPC 1.51 unpacks a whole message before it checks the size.
#pragma once

#include <zlib.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "server/front/call_filter.h"
#include "server/front/holding.h"

namespace axisgate::front {

// Not thread safe.
class RequestBody {
 public:
  // `encoding` is the call's grpc-encoding; empty: none. `all` must outlive this object.
  RequestBody(std::string_view encoding, std::size_t message_bytes, HeldBytes& all);

  // Appends to `out` the uncompressed messages in these bytes. Returns the answer to the call if the bytes cannot be
  // taken.
  std::optional<Reply> take(std::string_view bytes, std::string& out);
  // Ends the accounting for messages that take() gave out; another object accounts for them after this call.
  void passed_on() { unpacked_.give_back(std::exchange(given_out_, 0)); }

  // Reports whether a message is incomplete.
  bool unfinished() const { return !prefix_.empty(); }
  // Returns the number of bytes unpacked since the last call.
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
  std::string prefix_;                  // of the present message
  std::size_t left_ = 0;                // bytes of the present message still to come
  std::unique_ptr<Inflater> inflater_;  // null for an uncompressed message
  std::string message_;                 // unpacked part of the present message
  Holding unpacked_;                    // for message_, and for messages that were given out
  std::size_t given_out_ = 0;
  std::size_t cost_ = 0;
};

// Returns the message as a body carries it.
std::string with_prefix(std::string_view message);
// Returns the only message of a body without compression. nullopt if there is none, or more than one.
std::optional<std::string_view> only_message(std::string_view body);

}  // namespace axisgate::front
