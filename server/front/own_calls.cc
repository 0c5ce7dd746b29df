#include "server/front/own_calls.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/front/replies.h"
#include "server/front/request_body.h"

namespace axisgate::front {
bool OwnCalls::within_limits() const {
  const auto uncounted = std::ranges::count_if(calls_, [](const auto& entry) { return entry.second.place == nullptr; });
  return static_cast<std::size_t>(uncounted) < limits_.answers && requests_bytes_ <= limits_.requests_bytes;
}

void OwnCalls::begin(std::uint32_t stream, Headers headers, std::shared_ptr<void> place) {
  Call& call = calls_[stream];
  call.headers = std::move(headers);
  call.place = std::move(place);
  call.window = first_window_;
}

Reply OwnCalls::refused(std::uint32_t stream, int code, std::string why) {
  forget(stream);
  return {.code = code, .message = std::move(why)};
}

std::optional<Reply> OwnCalls::take(std::uint32_t stream, std::string_view content) {
  Call& call = calls_.at(stream);
  if (call.asked) return std::nullopt;
  if (call.request.size() + content.size() > limits_.message_bytes) {
    return refused(stream, kResourceExhausted,
                   fmt::format("a request of this method has at most {} bytes", limits_.message_bytes));
  }
  call.request.append(content);
  requests_bytes_ += content.size();
  return std::nullopt;
}

std::optional<Reply> OwnCalls::ask(std::uint32_t stream) {
  Call& call = calls_.at(stream);
  if (std::exchange(call.asked, true)) return std::nullopt;
  requests_bytes_ -= call.request.size();
  const auto message = message_in(call.request, limits_.message_bytes);
  call.request = {};
  if (!message) return refused(stream, kInvalidArgument, "the request is not one whole message");
  call.answer = desk_.answer(call.headers, peer_, *message, [on_answer = on_answer_, stream] { on_answer(stream); });
  return std::nullopt;
}

void OwnCalls::forget(std::uint32_t stream) {
  const auto found = calls_.find(stream);
  if (found == calls_.end()) return;
  requests_bytes_ -= found->second.request.size();
  calls_.erase(found);
  due_.erase(stream);
}

void OwnCalls::pull(std::uint32_t stream) {
  const auto found = calls_.find(stream);
  if (found == calls_.end() || !found->second.answer) return;
  Call& call = found->second;
  for (const Reply& reply : call.answer->take()) {
    if (reply.body) {
      if (!std::exchange(call.begun, true)) call.head = head_frame(stream);
      call.messages += with_prefix(*reply.body);
    }
    if (reply.last) call.ending = ending_frame(stream, reply, !call.begun);
  }
  due_.insert(stream);
}

void OwnCalls::set_first_window(std::int64_t bytes) {
  const std::int64_t more = bytes - std::exchange(first_window_, bytes);
  for (auto& [stream, call] : calls_) call.window += more;
}

bool OwnCalls::widen(std::uint32_t stream, std::int64_t bytes) {
  Call& call = calls_.at(stream);
  call.window += bytes;
  return call.window <= kWindowMax;
}

// True: all of it that was there is sent.
bool OwnCalls::send(std::uint32_t stream, Call& call, std::int64_t& window, std::string& out) {
  out += std::exchange(call.head, {});
  while (!call.messages.empty()) {
    const std::int64_t room = std::min({window, call.window, static_cast<std::int64_t>(kFramePayloadMax)});
    if (room <= 0) return false;
    const std::size_t size = std::min(call.messages.size(), static_cast<std::size_t>(room));
    out += frame(FrameType::data, 0, stream, std::string_view(call.messages).substr(0, size));
    call.messages.erase(0, size);
    call.window -= static_cast<std::int64_t>(size);
    window -= static_cast<std::int64_t>(size);
  }
  return true;
}

std::string OwnCalls::frames(std::int64_t& window) {
  std::string out;
  for (auto due = due_.begin(); due != due_.end();) {
    const std::uint32_t stream = *due;
    Call& call = calls_.at(stream);
    if (!send(stream, call, window, out)) {
      ++due;
      continue;
    }
    due = due_.erase(due);
    if (!call.ending) continue;
    out += *call.ending;
    calls_.erase(stream);
  }
  return out;
}

}  // namespace axisgate::front
