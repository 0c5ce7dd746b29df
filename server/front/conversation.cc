#include "server/front/conversation.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "server/front/replies.h"
#include "server/limits.h"

namespace axisgate::front {
namespace {

constexpr std::int64_t kPrefaceBytes = 24, kFrameHeadBytes = 9;  // RFC 9113, 3.4 and 4.1
constexpr std::uint32_t kStreamWindow = 64 << 10;
constexpr std::int32_t kConnectionWindow = 8 << 20;  // large enough that a few waiting requests do not block others

SessionTerms terms_of(const FrontLimits& limits) {
  return {.list_bytes = limits.header_bytes,
          .list_fields = limits.header_fields,
          .open_streams = static_cast<std::uint32_t>(limits.open_calls),
          .stream_window = kStreamWindow,
          .connection_window = kConnectionWindow};
}

bool has_flag(const nghttp2_frame_hd& frame, nghttp2_flag flag) { return (frame.flags & flag) != 0; }

bool is_own(const Header& header) { return header.name == kCallerHeader || header.name == kSourceHeader; }

// Returns the answer to a request that is not a gRPC call: gRPC's protocol over HTTP/2 requires POST and its content
// type.
std::optional<Headers> not_grpc(const Headers& headers) {
  if (find(headers, ":method") != "POST") return Headers{{":status", "405"}, {"allow", "POST"}};
  const std::string_view type = find(headers, "content-type").value_or("");
  constexpr std::string_view kGrpc = "application/grpc";
  const bool grpc = type.starts_with(kGrpc) && (type.size() == kGrpc.size() || type[kGrpc.size()] == '+' ||
                                                type[kGrpc.size()] == ';' || type[kGrpc.size()] == ' ');
  if (!grpc) return Headers{{":status", "415"}};
  return std::nullopt;
}

Reply too_much_metadata(const FrontLimits& limits) {
  return {.code = kResourceExhausted,
          .message = fmt::format("the metadata of this call is too long: the daemon takes {} bytes in {} fields, as "
                                 "RFC 9113 counts them (6.5.2)",
                                 limits.header_bytes, limits.header_fields)};
}

// Only compressed messages are refused in this way. Other messages wait in the client, whose window does not grow.
Reply too_much_waits() {
  return {.code = kResourceExhausted,
          .message = "the messages of this request are much longer unpacked, and come faster than they are taken",
          .retry_after = server::kRetryAfter};
}

Reply too_many_open() {
  return {.code = kResourceExhausted,
          .message = "too many stops and lists are open on this connection (wait for some of them)",
          .retry_after = server::kRetryAfter};
}

}  // namespace

Conversation::Conversation(const Shared& shared, Peer peer, bool stops_only, OwnCalls::OnAnswer on_answer,
                           TimePoint now)
    : shared_(shared),
      peer_(std::move(peer)),
      spending_(shared.limits, shared.sources, peer_.source, now),
      stops_only_(stops_only),
      now_(now),
      client_(Http2Session::Role::server, terms_of(shared.limits), *this),
      own_calls_(shared.filter, peer_, shared.held, client_, std::move(on_answer)),
      unshown_(-kPrefaceBytes) {}

void Conversation::from_client(std::string_view bytes, TimePoint now) {
  now_ = now;
  if (over_) return;
  client_leaves_ = false;
  const bool was_within = is_within();
  pace_.came(bytes.size());
  unshown_ += static_cast<std::int64_t>(bytes.size());
  if (client_.feed(bytes)) spend_for_unshown();
  if (block_ends_ && unshown_ >= 0) in_block_ = false;  // the library does not report a block that it ignores
  if (!was_within) pace_.begin(now);
}

// Reports whether the head of a frame or the headers of a call are incomplete.
bool Conversation::is_within() const { return in_block_ || (unshown_ > 0 && !strays_); }

void Conversation::from_grpc(std::string_view bytes) {
  if (grpc_) grpc_->from_grpc(bytes);
}

bool Conversation::end(Cause cause, std::uint32_t error, const char* why) {
  client_.end(error, why);
  over_ = true;
  fault_ = Closing{cause, why};
  return false;
}

void Conversation::failed(std::uint32_t error, std::string_view why) {
  over_ = true;
  // A client that disconnects with GOAWAY may name a wrong stream: grpc-go names one of its own as the last stream.
  if (client_leaves_) return;
  fault_ = Closing{error == NGHTTP2_ENHANCE_YOUR_CALM ? Cause::over_budget : Cause::protocol_error, std::string(why)};
}

bool Conversation::spend(Cost cost, double tokens) {
  if (over_) return false;
  if (spending_.spend(cost, tokens, now_)) return true;
  return end(Cause::over_budget, NGHTTP2_ENHANCE_YOUR_CALM,
             "more frames a second than the daemon takes from one client");
}

bool Conversation::frame_begun(const nghttp2_frame_hd& frame) {
  unshown_ -= kFrameHeadBytes + static_cast<std::int64_t>(frame.length);
  strays_ = false;
  client_leaves_ = frame.type == NGHTTP2_GOAWAY;
  if (over_) return false;
  if (frame.type == NGHTTP2_HEADERS || frame.type == NGHTTP2_CONTINUATION) return spend_for_headers(frame);
  in_block_ = false;
  return spend_for(frame);
}

bool Conversation::spend_for_headers(const nghttp2_frame_hd& frame) {
  block_ends_ = has_flag(frame, NGHTTP2_FLAG_END_HEADERS);
  if (!spend(Cost::header_bytes, static_cast<double>(frame.length))) return false;
  if (frame.type == NGHTTP2_CONTINUATION) {
    block_bytes_ += frame.length;
    if (++continuations_ <= shared_.limits.continuations) return true;
    return end(Cause::over_budget, NGHTTP2_ENHANCE_YOUR_CALM, "headers in more pieces than the daemon takes");
  }
  const bool begins_call = frame.stream_id > last_stream_;
  last_stream_ = std::max(last_stream_, frame.stream_id);
  block_bytes_ = frame.length;
  continuations_ = 0;
  in_block_ = begins_call || calls_.contains(frame.stream_id);
  if (begins_call) return spend(Cost::stream, 1);
  return in_block_ || spend_for_nobodys(kFrameHeadBytes + frame.length, 1);
}

bool Conversation::spend_for(const nghttp2_frame_hd& frame) {
  switch (frame.type) {
    case NGHTTP2_DATA: {
      const bool may_be_empty = frame.length == 0 || has_flag(frame, NGHTTP2_FLAG_PADDED);
      return !may_be_empty || has_flag(frame, NGHTTP2_FLAG_END_STREAM) || spend(Cost::control, 1);
    }
    case NGHTTP2_PRIORITY:
      // The library ignores all PRIORITY frames; RFC 9113, 6.3 does not allow this one.
      if (frame.stream_id == 0) return end(Cause::protocol_error, NGHTTP2_PROTOCOL_ERROR, "PRIORITY of no stream");
      return spend(Cost::control, 1);
    case NGHTTP2_SETTINGS:
      if (!has_flag(frame, NGHTTP2_FLAG_ACK)) return spend(Cost::settings, 1);
      if (settings_due_ == 0) return spend(Cost::control, 1);
      --settings_due_;
      return true;
    case NGHTTP2_RST_STREAM:
      return spend(Cost::reset, 1);
    case NGHTTP2_WINDOW_UPDATE:
      if (acknowledgements_due_ == 0) return spend(Cost::control, 1);
      --acknowledgements_due_;
      return true;
    default:
      return spend(Cost::control, 1);
  }
}

// Charges frames of no call. They are free as long as an honest client may have sent them before it learned that its
// call is over.
bool Conversation::spend_for_nobodys(std::size_t bytes, std::size_t frames) {
  if (free_ < bytes) return spend(Cost::control, static_cast<double>(frames));
  free_ -= bytes;
  return true;
}

// The library does not report DATA of closed streams. Charges as many frames as these bytes can contain; fewer bytes
// than the head of a frame may be the beginning of the next frame.
void Conversation::spend_for_unshown() {
  if (over_ || unshown_ < kFrameHeadBytes) return;
  const auto bytes = static_cast<std::size_t>(std::exchange(unshown_, 0));
  strays_ = true;
  spend_for_nobodys(bytes, bytes / kFrameHeadBytes);
}

bool Conversation::frame_refused() {
  in_block_ = false;
  free_ += kStreamWindow;
  return spend(Cost::refusal, 1);
}

bool Conversation::headers_came(HeaderBlock block) {
  in_block_ = false;
  const std::size_t unpacked = block.bytes - std::min(block.bytes, block_bytes_);
  if (!spend(Cost::header_bytes, static_cast<double>(unpacked))) return false;
  if (!block.trailers) return begin_call(std::move(block));
  request_is_whole(block.stream);
  return true;
}

bool Conversation::begin_call(HeaderBlock block) {
  if (daemon_ends_) {
    client_.reset(block.stream, NGHTTP2_REFUSED_STREAM);
    free_ += kStreamWindow;
    return true;
  }
  if (!block.fits) {
    refuse(block.stream, too_much_metadata(shared_.limits));
    return true;
  }
  if (const auto answer = not_grpc(block.headers)) {
    client_.respond(block.stream, *answer, true);
    free_ += kStreamWindow;
    return spend(Cost::refusal, 1);
  }
  const Decision decision = shared_.filter.decide(block.headers, peer_, stops_only_);
  if (decision.denied && !spend(Cost::refusal, 1)) return false;
  if (!decision.denied) spending_.admit(decision.caller, now_);
  if (decision.what == Decision::What::refuse) {
    refuse(block.stream, decision.refusal);
  } else {
    let_in(std::move(block), decision);
  }
  return true;
}

void Conversation::let_in(HeaderBlock block, const Decision& decision) {
  const auto uncounted = std::ranges::count_if(calls_, [](const auto& call) { return call.second.uncounted; });
  if (decision.uncounted && static_cast<std::size_t>(uncounted) >= shared_.limits.answers) {
    return refuse(block.stream, too_many_open());
  }
  const StreamId stream = block.stream;
  Call& call = calls_[stream];
  call.place = decision.place;
  call.uncounted = decision.uncounted;
  call.request = std::make_unique<RequestBody>(
      find(block.headers, "grpc-encoding").value_or(""),
      decision.uncounted ? shared_.limits.stop_bytes : shared_.limits.message_bytes, shared_.held);
  call.pace.begin(now_);
  const bool whole = block.last;
  if (decision.what == Decision::What::answer) {
    own_calls_.begin(stream, std::move(block.headers));
  } else {
    call.forwarded = true;
    forward(std::move(block), decision.path);
  }
  if (whole) request_is_whole(stream);
}

void Conversation::forward(HeaderBlock block, const std::string& path) {
  if (!grpc_) grpc_.emplace(client_, shared_.held);
  // Drops the client's own headers with reserved names. Messages reach gRPC uncompressed, so grpc-encoding and
  // content-length go as well. user-agent is not used, and gRPC would keep it as long as the call.
  std::erase_if(block.headers, [](const Header& one) {
    return is_own(one) || one.name == "grpc-encoding" || one.name == "content-length" || one.name == "user-agent";
  });
  std::ranges::find(block.headers, ":path", &Header::name)->value = path;
  block.headers.push_back({kCallerHeader, peer_.who});
  block.headers.push_back({kSourceHeader, peer_.source});
  grpc_->begin(block.stream, block.headers, block.last);
}

bool Conversation::data_came(StreamId stream, std::string_view bytes) {
  const auto found = calls_.find(stream);
  if (found == calls_.end() || !found->second.request) {
    client_.consume(stream, bytes.size());
    return true;
  }
  const auto refusal = take(stream, found->second, bytes);
  const std::size_t cost = found->second.request->take_cost();
  if (refusal) refuse(stream, *refusal);
  return cost == 0 || spend(Cost::unpacked, static_cast<double>(cost));
}

std::optional<Reply> Conversation::take(StreamId stream, Call& call, std::string_view bytes) {
  std::string out;
  if (!call.request->unfinished()) call.pace.begin(now_);
  call.pace.came(bytes.size());
  auto refusal = call.request->take(bytes, out);
  call.request->passed_on();
  if (!refusal && grpc_ && grpc_->has(stream)) {
    const std::size_t waits = grpc_->waiting(stream);
    if (waits > 0 && waits + out.size() > shared_.limits.message_bytes) return too_much_waits();
    grpc_->pass(stream, out, bytes.size());
    return std::nullopt;
  }
  client_.consume(stream, bytes.size());
  if (!refusal && own_calls_.has(stream)) refusal = own_calls_.take(stream, out);
  return refusal;
}

bool Conversation::stream_ended(StreamId stream) {
  request_is_whole(stream);
  return !over_;
}

void Conversation::request_is_whole(StreamId stream) {
  const auto found = calls_.find(stream);
  if (found == calls_.end() || !found->second.request) return;
  found->second.request.reset();
  if (!own_calls_.has(stream)) return grpc_->end_request(stream);
  own_calls_.ask(stream);
}

void Conversation::refuse(StreamId stream, const Reply& refusal) {
  free_ += kStreamWindow;
  own_calls_.forget(stream);
  if (const auto found = calls_.find(stream); found != calls_.end()) found->second.request.reset();
  if (grpc_ && grpc_->has(stream)) {
    return grpc_->refuse(stream, answer_without_body(refusal), trailers_of(refusal));
  }
  client_.respond(stream, answer_without_body(refusal), true);
}

void Conversation::stream_closed(StreamId stream, std::uint32_t, std::size_t unsent) {
  own_calls_.forget(stream);
  const auto call = calls_.find(stream);
  if (call == calls_.end()) return;
  if (grpc_ && call->second.forwarded) grpc_->forget(stream, unsent);
  if (call->second.request) free_ += kStreamWindow;
  calls_.erase(call);
}

// Clients acknowledge what they receive with WINDOW_UPDATE, once for the stream and once for the connection. These are
// free; otherwise, the acknowledgements of a thousand event streams would count as a flood.
void Conversation::sent(StreamId stream, std::size_t bytes) {
  constexpr int kAcknowledgements = 2, kMost = 100'000;
  acknowledgements_due_ = std::min(acknowledgements_due_ + kAcknowledgements, kMost);
  const auto call = calls_.find(stream);
  if (grpc_ && call != calls_.end() && call->second.forwarded) grpc_->delivered(stream, bytes);
}

void Conversation::grpc_failed() {
  stops_only_ = true;
  if (!grpc_) return;
  std::vector<StreamId> calls;
  for (const auto& [stream, call] : calls_) {
    if (grpc_->has(stream)) calls.push_back(stream);
  }
  grpc_.reset();
  for (const StreamId stream : calls) refuse(stream, shared_.filter.no_room());
}

void Conversation::announce_end() {
  daemon_ends_ = true;
  client_.announce_end();
}

void Conversation::grpc_left() {
  if (grpc_) grpc_->lost();
}

void Conversation::check(TimePoint now, bool reads) {
  if (over_) return;
  now_ = now;
  if (!reads) pace_.begin(now);
  if (is_within() && pace_.stalled(shared_.limits.pace, now)) {
    end(Cause::frame_unfinished, NGHTTP2_ENHANCE_YOUR_CALM, "a frame was not finished in time");
    return;
  }
  check_requests(now, reads);
}

void Conversation::check_requests(TimePoint now, bool reads) {
  std::vector<StreamId> stalled;
  for (auto& [stream, call] : calls_) {
    const bool own = own_calls_.has(stream);
    const bool awaited = call.request && (own || call.request->unfinished());
    if (!awaited || !reads || (!own && grpc_->waiting(stream) > 0)) {
      call.pace.begin(now);
    } else if (call.pace.stalled(shared_.limits.pace, now)) {
      stalled.push_back(stream);
    }
  }
  const FrontLimits& limits = shared_.limits;
  for (const StreamId stream : stalled) {
    refuse(stream,
           {.code = kDeadlineExceeded,
            .message = fmt::format("the request began, but did not continue: at least {} bytes are expected "
                                   "in each {} s",
                                   limits.pace.bytes,
                                   std::chrono::duration_cast<std::chrono::seconds>(limits.pace.span).count())});
  }
}

}  // namespace axisgate::front
