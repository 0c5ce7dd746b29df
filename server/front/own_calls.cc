#include "server/front/own_calls.h"

#include <algorithm>
#include <utility>

#include "server/front/replies.h"
#include "server/front/request_body.h"

namespace axisgate::front {
void OwnCalls::begin(StreamId stream, Headers headers) {
  calls_.try_emplace(stream, Call{.headers = std::move(headers), .holding = Holding(held_)});
  client_.put_first(stream);
}

std::optional<Reply> OwnCalls::take(StreamId stream, std::string_view bytes) {
  Call& call = calls_.at(stream);
  const std::size_t before = counted(call.request.size());
  if (!call.holding.take(counted(call.request.size() + bytes.size()) - before)) {
    return Reply{.code = kResourceExhausted,
                 .message = "too many long requests are on their way at the same time (try again in 1 s)"};
  }
  call.request.append(bytes);
  return std::nullopt;
}

void OwnCalls::ask(StreamId stream) {
  Call& call = calls_.at(stream);
  call.answer = filter_.answer(call.headers, peer_, only_message(call.request),
                               [on_answer = on_answer_, stream] { on_answer(stream); });
  call.holding.give_back();
  call.request = {};
}

void OwnCalls::pull(StreamId stream) {
  const auto found = calls_.find(stream);
  if (found == calls_.end() || !found->second.answer) return;
  Call& call = found->second;
  for (const Reply& reply : call.answer->take()) {
    if (reply.body) {
      if (!std::exchange(call.begun, true)) client_.respond(stream, answer_head(), false);
      client_.write(stream, with_prefix(*reply.body));
    }
    if (!reply.last) continue;
    if (call.begun) return client_.finish(stream, trailers_of(reply));
    return client_.respond(stream, answer_without_body(reply), true);
  }
}

}  // namespace axisgate::front
