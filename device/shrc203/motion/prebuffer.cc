#include "device/shrc203/motion/prebuffer.h"

#include <fmt/format.h>

#include <utility>

#include "device/core/guard.h"
#include "device/shrc203/command/builders.h"

namespace axisgate::shrc203 {

// Returns the content of the prebuffer compared with the setter; nullopt if it could not be read.
Task<std::optional<Held>> Prebuffer::read(LiveMotionPtr live, Command setter) {
  const auto question = commands::question_of(setter.row->reg);
  const auto answer = co_await dialogue_.ask(question, Lane::path_refill, live->context.who);
  if (!answer.reply || answer.problem || answer.reply->kind != Reply::Kind::data) co_return std::nullopt;
  co_return held(*answer.reply, setter, store_.controllable());
}

Task<bool> Prebuffer::is_empty(LiveMotionPtr live, Sent sent) {
  auto found = co_await read(live, sent.setter);
  if (found == Held::other && guarded(Guard::wrong_segments_stop)) {
    // The changed segment may move any axis. The reply itself may have been misread, so it is read again.
    line_.completions().chained(kAllAxes, tasks_.now());
    found = co_await read(live, sent.setter);
    if (found == Held::other) co_await stop_wrong_segment(live, std::move(sent));
  }
  co_return found == Held::nothing;
}

Task<void> Prebuffer::stop_wrong_segment(LiveMotionPtr live, Sent sent) {
  stops_.stop(kAllAxes, {.who = "the gateway (the line changed a segment)"});
  co_await standstill_.wait(live);
  motions_.end(
      *live, MotionState::failed,
      Problem{.reason = Reason::line_fault,
              .message = fmt::format("segment {} was received wrongly, and all axes were stopped", sent.number),
              .hint = "check the cable and the line settings, and check the positions",
              .sent = sent.setter.line});
}

}  // namespace axisgate::shrc203
