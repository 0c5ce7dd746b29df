// The way of one client's calls to gRPC, and of its answers back: a connection of its own, whose streams have the
// numbers of the client's. Bytes go no faster than the side that receives them allows. No I/O, no threads.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "server/front/headers.h"
#include "server/front/holding.h"
#include "server/front/http2_session.h"

namespace axisgate::front {

class GrpcSide final : private Http2Session::Events {
 public:
  // Both outlive it. `client` is the session with the client.
  GrpcSide(Http2Session& client, HeldBytes& held);

  bool has(StreamId stream) const { return calls_.contains(stream); }

  void begin(StreamId stream, const Headers& headers, bool whole);
  // Part of a request. The client may send `size` bytes again when gRPC has taken these.
  void pass(StreamId stream, std::string_view bytes, std::size_t size);
  void end_request(StreamId stream) { session_.finish(stream, {}); }
  // Bytes of the request that gRPC has not taken yet.
  std::size_t waiting(StreamId stream) const { return session_.unsent(stream); }
  // The answer is given here, not by gRPC.
  void refuse(StreamId stream, const Headers& alone, Headers trailers);
  // The client's stream has gone; of the answer `unsent` bytes did not reach it.
  void forget(StreamId stream, std::size_t unsent);
  // Reports that as many bytes of an answer are on their way to the client.
  void delivered(StreamId stream, std::size_t bytes) { session_.consume(stream, bytes); }
  // gRPC has closed the connection.
  void lost();

  void from_grpc(std::string_view bytes) { session_.feed(bytes); }
  std::string take_to_grpc(std::size_t limit) { return session_.take(limit); }
  bool has_for_grpc() const { return session_.has_more(); }

 private:
  struct Call {
    Holding unpacked;          // what a request has become longer by
    std::size_t withheld = 0;  // bytes that the client may send again, and does not know
    bool answered = false;     // the head of the answer has been passed on
    bool ended = false;        // so has its end
  };

  bool frame_begun(const nghttp2_frame_hd&) override { return true; }
  bool frame_refused() override { return true; }
  bool headers_came(HeaderBlock block) override;
  bool data_came(StreamId stream, std::string_view bytes) override;
  bool stream_ended(StreamId stream) override;
  void stream_closed(StreamId stream, std::uint32_t error, std::size_t unsent) override;
  void sent(StreamId stream, std::size_t bytes) override;
  void going_away(StreamId last, std::uint32_t error) override;
  void failed(std::uint32_t error, std::string_view why) override;

  Http2Session& client_;
  HeldBytes& held_;
  Http2Session session_;
  std::map<StreamId, Call> calls_;
};

}  // namespace axisgate::front
