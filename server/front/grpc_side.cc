#include "server/front/grpc_side.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace axisgate::front {
namespace {

// gRPC may send 32 KiB of one answer, and 16 MiB of all answers, before the client has taken them. Answers that wait
// stay here, and other answers overtake them.
constexpr SessionTerms kTerms{.list_bytes = 256 << 10,
                              .list_fields = 1'000,
                              .open_streams = 0,
                              .stream_window = 32 << 10,
                              .connection_window = 16 << 20};

}  // namespace

GrpcSide::GrpcSide(Http2Session& client, HeldBytes& held)
    : client_(client), held_(held), session_(Http2Session::Role::client, kTerms, *this) {}

void GrpcSide::begin(StreamId stream, const Headers& headers, bool whole) {
  calls_.try_emplace(stream, Call{.unpacked = Holding(held_)});
  session_.request(stream, headers, whole);
}

void GrpcSide::pass(StreamId stream, std::string_view bytes, std::size_t size) {
  const auto call = calls_.find(stream);
  const bool nothing_waits = bytes.empty() && session_.unsent(stream) == 0;
  if (call == calls_.end() || nothing_waits) return client_.consume(stream, size);
  call->second.withheld += size;
  if (bytes.size() > size) call->second.unpacked.take(bytes.size() - size);  // RequestBody has already freed this room
  session_.write(stream, bytes);
}

void GrpcSide::sent(StreamId stream, std::size_t bytes) {
  const auto call = calls_.find(stream);
  if (call == calls_.end()) return;
  // Unpacked, a request has another length than the client sent. A share of the unpacked bytes counts as the same share
  // of the sent bytes.
  const auto all = static_cast<double>(bytes + session_.unsent(stream));
  const auto given = static_cast<std::size_t>(static_cast<double>(call->second.withheld * bytes) / all);
  call->second.withheld -= given;
  // The message counts until gRPC has taken all of it; until then gRPC keeps an incomplete message.
  if (session_.unsent(stream) == 0) call->second.unpacked.give_back();
  client_.consume(stream, given);
}

bool GrpcSide::headers_came(HeaderBlock block) {
  const auto call = calls_.find(block.stream);
  if (call == calls_.end()) return true;
  call->second.ended = block.last;
  if (std::exchange(call->second.answered, true)) {
    client_.finish(block.stream, std::move(block.headers));
  } else {
    client_.respond(block.stream, block.headers, block.last);
  }
  return true;
}

bool GrpcSide::data_came(StreamId stream, std::string_view bytes) {
  if (calls_.contains(stream)) {
    client_.write(stream, bytes);
  } else {
    session_.consume(stream, bytes.size());
  }
  return true;
}

bool GrpcSide::stream_ended(StreamId stream) {
  const auto call = calls_.find(stream);
  if (call == calls_.end()) return true;
  call->second.ended = true;
  client_.finish(stream, {});
  return true;
}

void GrpcSide::stream_closed(StreamId stream, std::uint32_t error, std::size_t) {
  const auto call = calls_.find(stream);
  if (call == calls_.end()) return;
  const bool ended = call->second.ended;
  client_.consume(stream, call->second.withheld);
  calls_.erase(call);
  if (!ended) client_.reset(stream, error == NGHTTP2_NO_ERROR ? std::uint32_t{NGHTTP2_INTERNAL_ERROR} : error);
}

void GrpcSide::refuse(StreamId stream, const Headers& alone, Headers trailers) {
  const auto call = calls_.find(stream);
  if (call == calls_.end() || call->second.ended) return;
  call->second.ended = true;
  if (call->second.answered) {
    client_.finish(stream, std::move(trailers));
  } else {
    client_.respond(stream, alone, true);
  }
  session_.reset(stream, NGHTTP2_CANCEL);
}

void GrpcSide::forget(StreamId stream, std::size_t unsent) {
  session_.consume(stream, unsent);
  const auto call = calls_.find(stream);
  if (call == calls_.end()) return;
  client_.consume(stream, call->second.withheld);
  calls_.erase(call);
  session_.reset(stream, NGHTTP2_CANCEL);
}

// gRPC sends two GOAWAYs. The first does not name a last stream, so calls that were sent before it still arrive.
void GrpcSide::going_away(StreamId last, std::uint32_t error) {
  if (error == NGHTTP2_NO_ERROR && last == std::numeric_limits<StreamId>::max()) return client_.announce_end();
  client_.end(NGHTTP2_NO_ERROR, "the daemon is ending");  // calls that the front answers itself continue
}

void GrpcSide::failed(std::uint32_t, std::string_view) { lost(); }

void GrpcSide::lost() {
  for (const auto& [stream, call] : std::exchange(calls_, {})) {
    client_.consume(stream, call.withheld);
    if (!call.ended) client_.reset(stream, NGHTTP2_INTERNAL_ERROR);
  }
  client_.end(NGHTTP2_NO_ERROR, "the daemon is ending");
}

}  // namespace axisgate::front
