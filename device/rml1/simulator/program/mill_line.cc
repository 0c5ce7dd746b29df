#include "device/rml1/simulator/program/mill_line.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

namespace axisgate::rml1::simulator {
namespace {

// Time whose bytes a fast line brings at once, because timers are not finer.
constexpr auto kPiece = std::chrono::milliseconds(1);
// Interval at which the setting of a stopped host is polled: no event reports a change.
constexpr auto kSettings = std::chrono::milliseconds(5);

}  // namespace

MillLine::MillLine(Strand strand, std::unique_ptr<HostEnd> end, Duration byte_time, std::size_t bytes_at_once)
    : MachineHost(std::move(strand)),
      end_(std::move(end)),
      byte_time_(byte_time),
      bytes_at_once_(std::clamp<std::size_t>(bytes_at_once, 1, kBytesMax)),
      pace_(this->strand()) {
  if (byte_time_ == Duration::zero()) return;
  bytes_at_once_ = std::clamp<std::size_t>(static_cast<std::size_t>(kPiece / byte_time_), 1, bytes_at_once_);
}

void MillLine::start(std::function<bool()> is_held_back) {
  is_held_back_ = std::move(is_held_back);
  look_later(Duration::zero());
}

void MillLine::shutdown() {
  detach();
  pace_.cancel();
  end_->close();
}

// Continues reading if the mill has released its host.
void MillLine::settle() {
  if (held_ && !is_held_back_()) look_later(Duration::zero());
}

void MillLine::look() {
  if (!attached()) return;
  held_ = is_held_back_();
  if (held_) {
    if (end_->may_change()) look_later(kSettings);
    return;
  }
  const TimePoint now = monotonic_now();
  if (line_free_ > now) return look_later(line_free_ - now);
  std::array<char, kBytesMax> bytes;
  const std::size_t size = end_->read(std::span(bytes).first(bytes_at_once_));
  if (size == 0) return await_bytes();
  line_free_ = std::max(line_free_, now - kPiece) + byte_time_ * size;
  call([&](LineMachine& machine, TimePoint at) { machine.receive({bytes.data(), size}, at); });
  look_later(std::max(Duration::zero(), line_free_ - monotonic_now()));
}

void MillLine::look_later(Duration time) {
  pace_.expires_after(time);
  pace_.async_wait([self = std::static_pointer_cast<MillLine>(shared_from_this())](const auto& error) {
    if (!error) self->look();
  });
}

void MillLine::await_bytes() {
  end_->awaited().async_wait(HostEnd::Stream::wait_read,
                             [self = std::static_pointer_cast<MillLine>(shared_from_this())](const auto& error) {
                               if (!error) self->look();
                             });
}

}  // namespace axisgate::rml1::simulator
