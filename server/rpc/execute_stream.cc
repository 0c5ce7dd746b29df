#include "server/rpc/execute_stream.h"

#include <fmt/format.h>

#include <chrono>
#include <utility>

#include "device/core/escape.h"
#include "server/rpc/status.h"

namespace axisgate::rpc {
namespace {

// Longer than any line of the controller.
constexpr std::size_t kDeviceTextMax = 512;

// What the controller says itself as the time runs out is more exact than that it has run out.
constexpr Duration kTimeoutGrace = std::chrono::milliseconds(100);

Problem timed_out(Duration timeout) {
  return {.reason = Reason::deadline_passed,
          .message = fmt::format("not all replies and completions came within {} s",
                                 std::chrono::duration_cast<std::chrono::duration<double>>(timeout).count()),
          .hint = "what moves goes on: WatchDevice shows it, Stop ends it"};
}

}  // namespace

ExecuteStream* ExecuteStream::start(server::Gateway& gateway, server::Device& device, stage::ExecuteRequest transaction,
                                    Duration timeout, StreamLimit::Place place) {
  std::shared_ptr<ExecuteStream> stream(new ExecuteStream(std::move(place)));
  stream->open();
  device.post([stream, transaction = std::move(transaction)](stage::StageController& controller, TimePoint now) {
    controller.execute(transaction, now, [stream](const stage::ExecuteEvent& event) { stream->on_event(event); });
  });
  gateway.after(timeout + kTimeoutGrace, [waiting = std::weak_ptr(stream), timeout] {
    if (const auto still = waiting.lock()) still->end(to_status(timed_out(timeout)));
  });
  return stream.get();
}

void ExecuteStream::on_event(const stage::ExecuteEvent& event) {
  using Kind = stage::ExecuteEvent::Kind;
  if (event.kind == Kind::ended) return end(event.problem ? to_status(*event.problem) : grpc::Status::OK);
  api::ExecuteResponse response;
  if (event.kind == Kind::completion) {
    response.set_completion(event.axis);
  } else {
    api::LineReply& reply = *response.mutable_reply();
    reply.set_line(static_cast<int>(event.line));
    reply.set_answer(escaped(event.answer, kDeviceTextMax));
    reply.set_sent(event.sent);
    reply.set_wire_reply(escaped(event.wire_reply, kDeviceTextMax));
  }
  {
    const std::lock_guard lock(mutex_);
    due_.push_back(std::move(response));
  }
  pump();
}

// The first end counts.
void ExecuteStream::end(grpc::Status status) {
  {
    const std::lock_guard lock(mutex_);
    if (!end_) end_ = std::move(status);
  }
  pump();
}

ExecuteStream::Next ExecuteStream::next() {
  if (!due_.empty()) {
    api::ExecuteResponse response = std::move(due_.front());
    due_.pop_front();
    return response;
  }
  if (end_) return *end_;
  return Wait{};
}

}  // namespace axisgate::rpc
