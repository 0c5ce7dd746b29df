// Connection of one client to gRPC, with the same stream numbers as the client's connection. Carries calls to gRPC and
// answers back, no faster than the receiver allows. No I/O, no threads.
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
  // `client` is the session with the client. Both objects must outlive this one.
  GrpcSide(Http2Session& client, HeldBytes& held);

  bool has(StreamId stream) const { return calls_.contains(stream); }

  void begin(StreamId stream, const Headers& headers, bool whole);
  // Sends part of a request. The client may send `size` more bytes when gRPC has taken these bytes.
  void pass(StreamId stream, std::string_view bytes, std::size_t size);
  void end_request(StreamId stream) { session_.finish(stream, {}); }
  // Returns the number of bytes of the request that gRPC has not taken yet.
  std::size_t waiting(StreamId stream) const { return session_.unsent(stream); }
  // Gives the front's own answer instead of gRPC's.
  void refuse(StreamId stream, const Headers& alone, Headers trailers);
  // Called when the client's stream has closed. `unsent` bytes of the answer did not reach the client.
  void forget(StreamId stream, std::size_t unsent);
  // Reports that `bytes` of an answer were sent to the client.
  void delivered(StreamId stream, std::size_t bytes) { session_.consume(stream, bytes); }
  // Called when gRPC has closed the connection.
  void lost();

  void from_grpc(std::string_view bytes) { session_.feed(bytes); }
  std::string take_to_grpc(std::size_t limit) { return session_.take(limit); }
  bool has_for_grpc() const { return session_.has_more(); }

 private:
  struct Call {
    Holding unpacked;          // bytes by which unpacking has lengthened the request
    std::size_t withheld = 0;  // received bytes for which the client has no permission to send more yet
    bool answered = false;     // the head of the answer has been passed on
    bool ended = false;        // the end of the answer has been passed on
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
