// The calls of one client, from the first byte of the connection: forwards calls to gRPC, answers the others, and ends
// the connection if it costs too much. No I/O, no threads: bytes in, bytes out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/time.h"
#include "server/front/budget.h"
#include "server/front/call_filter.h"
#include "server/front/closing.h"
#include "server/front/grpc_side.h"
#include "server/front/headers.h"
#include "server/front/http2_session.h"
#include "server/front/limits.h"
#include "server/front/own_calls.h"
#include "server/front/pace.h"
#include "server/front/request_body.h"
#include "server/front/spending.h"

namespace axisgate::front {

class Conversation final : private Http2Session::Events {
 public:
  // Objects shared by all conversations, which they must outlive.
  struct Shared {
    CallFilter& filter;
    const FrontLimits& limits;
    Sources& sources;
    HeldBytes& held;
  };

  Conversation(const Shared& shared, Peer peer, bool stops_only, OwnCalls::OnAnswer on_answer, TimePoint now);

  void from_client(std::string_view bytes, TimePoint now);
  void from_grpc(std::string_view bytes);
  // Fetches more of the answer for this call, after on_answer.
  void pull(StreamId stream) { own_calls_.pull(stream); }
  // Ends calls that stall. `reads`: the client is being read, so missing bytes were not sent.
  void check(TimePoint now, bool reads);

  // Called if gRPC cannot be reached: refuses its calls and, from now on, serves only stops.
  void grpc_failed();
  // Announces the end of the daemon to the client before its calls end, so that the client does not repeat them here.
  // Later calls are refused with REFUSED_STREAM, so that a client may make them elsewhere.
  void announce_end();
  // Called when gRPC has closed its side: the connection is over when the remaining answers have been written.
  void grpc_left();

  // Returns the bytes to be written next, each once.
  std::string take_to_client() { return client_.take(kPiece); }
  std::string take_to_grpc() { return grpc_ ? grpc_->take_to_grpc(kPiece) : std::string(); }
  bool has_for_client() const { return client_.has_more(); }
  bool has_for_grpc() const { return grpc_ && grpc_->has_for_grpc(); }
  // Reports that too many frames wait for the client; no more bytes are then read from it.
  bool full() const { return client_.waiting() > kWaiting; }

  bool uses_grpc() const { return grpc_.has_value(); }
  // Reports that no more bytes are to be read and that the connection closes when the rest has been written. Stays
  // true, whatever answers still come.
  bool over() { return over_ = over_ || client_.is_over(); }
  // Reason of the end, if this side ended the connection for a cause.
  const std::optional<Closing>& fault() const { return fault_; }
  // Earliest time at which the client may be read again.
  TimePoint not_before() const { return spending_.not_before(); }
  bool stops_only() const { return stops_only_; }
  bool admitted() const { return spending_.admitted(); }  // a call was let in
  std::size_t calls() const { return calls_.size(); }

 private:
  static constexpr std::size_t kPiece = 64 << 10;
  static constexpr std::size_t kWaiting = 1'000;  // frames

  // State of an admitted call, until its stream closes.
  struct Call {
    std::shared_ptr<void> place;
    bool uncounted = false;
    bool forwarded = false;                  // to gRPC
    std::unique_ptr<RequestBody> request{};  // null once the request is whole, to save memory
    Pace pace{};
  };

  bool frame_begun(const nghttp2_frame_hd& frame) override;
  bool frame_refused() override;
  bool headers_came(HeaderBlock block) override;
  bool data_came(StreamId stream, std::string_view bytes) override;
  bool stream_ended(StreamId stream) override;
  void stream_closed(StreamId stream, std::uint32_t error, std::size_t unsent) override;
  void sent(StreamId stream, std::size_t bytes) override;
  void going_away(StreamId, std::uint32_t) override {}  // open streams continue
  void failed(std::uint32_t error, std::string_view why) override;

  bool spend(Cost cost, double tokens);
  bool spend_for(const nghttp2_frame_hd& frame);
  bool spend_for_headers(const nghttp2_frame_hd& frame);
  bool spend_for_nobodys(std::size_t bytes, std::size_t frames);
  void spend_for_unshown();
  bool is_within() const;
  bool end(Cause cause, std::uint32_t error, const char* why);

  bool begin_call(HeaderBlock block);
  void let_in(HeaderBlock block, const Decision& decision);
  void forward(HeaderBlock block, const std::string& path);
  std::optional<Reply> take(StreamId stream, Call& call, std::string_view bytes);
  void request_is_whole(StreamId stream);
  void refuse(StreamId stream, const Reply& refusal);
  void check_requests(TimePoint now, bool reads);

  const Shared& shared_;
  const Peer peer_;
  Spending spending_;
  bool stops_only_;
  TimePoint now_;
  bool over_ = false;
  bool daemon_ends_ = false;
  bool client_leaves_ = false;  // GOAWAY was the last frame in the newest bytes
  std::optional<Closing> fault_;

  std::map<StreamId, Call> calls_;
  Http2Session client_;
  OwnCalls own_calls_;
  std::optional<GrpcSide> grpc_;  // exists from the first call that is gRPC's

  StreamId last_stream_ = 0;
  bool in_block_ = false;          // headers of a call are incomplete
  std::size_t block_bytes_ = 0;    // of these headers, as sent
  bool block_ends_ = false;        // the newest frame ends the headers
  std::size_t continuations_ = 0;  // frames of these headers beyond the first
  Pace pace_;                      // of these headers, or of a frame's head
  std::int64_t unshown_;           // bytes received, less those of the preface and of frames that have begun
  bool strays_ = false;           // frames that the library does not report: the beginning of the next frame is unknown
  int settings_due_ = 1;          // acknowledgements of SETTINGS
  int acknowledgements_due_ = 0;  // WINDOW_UPDATEs for bytes sent
  std::size_t free_ = 0;          // bytes that may still come for refused calls
};

}  // namespace axisgate::front
