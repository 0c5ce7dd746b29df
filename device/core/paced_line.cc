#include "device/core/paced_line.h"

#include <algorithm>
#include <cmath>

namespace axisgate {

class PacedLine::DeviceSide : public ByteLink {
 public:
  explicit DeviceSide(PacedLine& owner) : owner_(owner) {}
  void write(std::string_view bytes) override { owner_.from_device(bytes); }
  void reopen(Duration wait) override {
    owner_.drop_bytes();
    owner_.outside_.reopen(wait);
  }

 private:
  PacedLine& owner_;
};

void PacedLine::Way::send(std::string_view bytes, TimePoint from, Duration byte_time) {
  for (const char byte : bytes.substr(0, kBytesUnderWayMax - std::min(kBytesUnderWayMax, bytes_.size()))) {
    free_ = std::max(free_, from) + byte_time;
    bytes_.push_back({byte, free_});
  }
}

std::string PacedLine::Way::arrived_by(TimePoint time) {
  std::string arrived;
  for (; !bytes_.empty() && bytes_.front().due <= time; bytes_.pop_front()) arrived += bytes_.front().value;
  return arrived;
}

std::optional<TimePoint> PacedLine::Way::next_arrival() const {
  return bytes_.empty() ? std::nullopt : std::optional(bytes_.front().due);
}

void PacedLine::Way::drop(TimePoint now) {
  bytes_.clear();
  free_ = now;
}

PacedLine::PacedLine(Pacing pacing, ByteLink& outside, const Factory& make_device)
    : pacing_(pacing), outside_(outside), device_side_(std::make_unique<DeviceSide>(*this)) {
  device_ = make_device(*device_side_);
}

PacedLine::~PacedLine() = default;

Duration PacedLine::byte_time() const {
  return pacing_.baud == 0 ? Duration::zero() : Duration(10'000'000'000LL / pacing_.baud);
}

TimePoint PacedLine::device_time(TimePoint shell) const {
  const auto passed = static_cast<double>((shell - *origin_).count());
  return *origin_ + Duration(static_cast<std::int64_t>(std::floor(passed * pacing_.speed)));
}

TimePoint PacedLine::shell_time(TimePoint device) const {
  const auto passed = static_cast<double>((device - *origin_).count());
  return *origin_ + Duration(static_cast<std::int64_t>(std::ceil(passed / pacing_.speed)));
}

void PacedLine::drop_bytes() {
  inward_.drop(shell_now_);
  outward_.drop(shell_now_);
}

void PacedLine::link_up(TimePoint now) {
  advance(now);
  drop_bytes();
  device_->link_up(device_now_);
}

void PacedLine::link_down(TimePoint now, std::string_view why) {
  advance(now);
  // A serial port sends the written bytes before it closes; the answers are lost.
  const std::string written = inward_.arrived_by(TimePoint::max());
  if (!written.empty()) device_->receive(written, device_now_);
  drop_bytes();
  device_->link_down(device_now_, why);
}

void PacedLine::receive(std::string_view bytes, TimePoint now) {
  advance(now);
  inward_.send(bytes, shell_now_, byte_time());
  advance(now);
}

void PacedLine::touch(TimePoint now, const std::function<void(TimePoint device_now)>& act) {
  advance(now);
  act(device_now_);
  advance(now);
}

void PacedLine::from_device(std::string_view bytes) {
  outward_.send(bytes, shell_now_ + pacing_.reply_delay, byte_time());
}

void PacedLine::advance(TimePoint now) {
  if (!origin_) origin_ = device_now_ = shell_now_ = now;
  const TimePoint until = std::max(shell_now_, now);
  for (auto next = next_deadline(); next && *next <= until; next = next_deadline()) step(*next);
  shell_now_ = until;
  run_device_to(until);
  write_due(until);
}

// Does everything that is due at this time: first the device's own actions, then the bytes that reach it.
void PacedLine::step(TimePoint until) {
  shell_now_ = std::max(shell_now_, until);
  run_device_to(shell_now_);
  const std::string arrived = inward_.arrived_by(shell_now_);
  if (!arrived.empty()) device_->receive(arrived, device_now_);
  write_due(shell_now_);
}

void PacedLine::run_device_to(TimePoint shell) {
  device_now_ = std::max(device_now_, device_time(shell));
  // Rounding must not leave a deadline of this time a nanosecond in the future.
  const auto due = device_->next_deadline();
  if (due && shell_time(*due) <= shell) device_now_ = std::max(device_now_, *due);
  device_->advance(device_now_);
}

void PacedLine::write_due(TimePoint until) {
  const std::string bytes = outward_.arrived_by(until);
  if (!bytes.empty()) outside_.write(bytes);
}

std::optional<TimePoint> PacedLine::next_deadline() const {
  std::optional<TimePoint> next;
  const auto consider = [&next](std::optional<TimePoint> time) {
    if (time && (!next || *time < *next)) next = time;
  };
  consider(inward_.next_arrival());
  consider(outward_.next_arrival());
  const auto due = origin_ ? device_->next_deadline() : std::nullopt;
  if (due) consider(std::max(shell_time(*due), shell_now_));
  return next;
}

}  // namespace axisgate
