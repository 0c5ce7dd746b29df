#include "tests/simulation/wire.h"

#include <fmt/format.h>

#include "device/core/escape.h"

namespace axisgate::simulation {
namespace {

constexpr std::size_t kLogLines = 120;

Duration milliseconds(std::int64_t count) { return std::chrono::milliseconds(count); }

}  // namespace

Faults Faults::mild() {
  Faults f;
  f.drop_reply = f.drop_notice = f.late_reply = f.late_notice = 0.001;
  f.split = 0.01;
  f.mishaps_an_hour = 1;
  return f;
}

Faults Faults::rough() {
  Faults f = mild();
  f.drop_command = f.drop_reply = f.late_reply = 0.005;
  f.double_notice = f.drop_notice = f.late_notice = 0.02;
  f.noise = f.flip_reply = 0.001;
  f.mishaps_an_hour = 5;
  return f;
}

std::optional<Faults> Faults::named(std::string_view profile) {
  if (profile == "quiet") return none();
  if (profile == "mild") return mild();
  if (profile == "rough") return rough();
  if (profile == "hostile") return hostile();
  return {};
}

Faults Faults::hostile() {
  Faults f;
  f.drop_command = f.drop_reply = 0.01;
  f.flip_command = f.null_in_command = 0.002;
  f.late_reply = 0.01;
  f.double_reply = 0.01;
  f.false_ng = 0.002;
  f.flip_reply = 0.005;
  f.noise = 0.005;
  f.split = 0.02;
  f.drop_notice = f.late_notice = f.double_notice = 0.05;
  f.flood_notice = 0.01;
  f.mishaps_an_hour = 20;
  return f;
}

void Wire::note(TimePoint now, const std::string& text) {
  log_.push_back(fmt::format("{:12.6f} {}", std::chrono::duration<double>(now.time_since_epoch()).count(), text));
  if (log_.size() > kLogLines) log_.pop_front();
}

bool Wire::strikes(double probability, const char* kind) { return random_.chance(probability) && inject(kind); }

bool Wire::inject(const char* kind) {
  const std::uint64_t number = drawn_++;
  if (spared_.contains(number)) return false;
  ++by_kind_[kind][static_cast<std::size_t>(phase_ ? phase_() : Phase::idle)];
  note(now_, fmt::format("   fault {}: {}", number, kind));
  return true;
}

std::string Wire::flipped(std::string text) {
  auto& byte = text[static_cast<std::size_t>(random_.between(0, static_cast<std::int64_t>(text.size()) - 1))];
  byte = static_cast<char>(byte ^ (1 << random_.between(0, 6)));
  return text;
}

void Wire::open(TimePoint now) {
  now_ = now;
  open_ = true;
  opens_at_.reset();
  device_->link_up(now);
  gateway_->link_up(now);
}

void Wire::cut(TimePoint now, Duration until_back) {
  now_ = now;
  if (!open_) return;
  note(now, "   the line is cut");
  open_ = false;
  in_transit_.clear();
  device_->link_down(now, "cut");
  gateway_->link_down(now, "unplugged");
  if (opens_at_) opens_at_ = std::max(*opens_at_, now + until_back);
}

void Wire::reopen(Duration wait) {
  note(now_, "   gateway reopens the line");
  in_transit_.clear();
  open_ = false;
  opens_at_ = now_ + wait;
}

// One write is one line: the gateway never writes less or more.
void Wire::from_gateway(std::string_view bytes) {
  std::string line(bytes.substr(0, bytes.find('\r')));
  commands_.push_back(line);
  note(now_, "> " + line);
  if (!open_) return;
  const Scripted fault = scripted(LineKind::command, line);
  to_device_free_ =
      std::max(to_device_free_, now_) + byte_time_ * static_cast<std::int64_t>(bytes.size()) + fault.delay;
  if (fault.drop) return;
  if (strikes(faults_.drop_command, "line: command dropped")) return;
  if (strikes(faults_.flip_command, "line: command flipped")) line = flipped(line);
  if (strikes(faults_.null_in_command, "line: NUL in command")) line.insert(line.size() / 2, 1, '\0');
  in_transit_.emplace(to_device_free_, Delivery{true, fault.instead.value_or(line + "\r\n"), {}, commands_.size() - 1});
}

void Wire::from_device(std::string_view bytes) {
  device_partial_ += bytes;
  while (true) {
    const auto end = device_partial_.find("\r\n");
    if (end == std::string::npos) return;
    std::string text = device_partial_.substr(0, end);
    device_partial_.erase(0, end + 2);
    device_line(std::move(text));
  }
}

// The device answers commands in order. One that a fault has cut in two is answered twice.
void Wire::device_line(std::string text) {
  Origin origin{Origin::Kind::notice, 0};
  if (device_answers_()) {
    if (!unanswered_.empty()) {
      last_answered_ = unanswered_.front();
      unanswered_.pop_front();
    }
    origin = {Origin::Kind::reply, last_answered_.value_or(0)};
  }
  if (!open_) return;
  const bool is_reply = origin.kind == Origin::Kind::reply;
  const Scripted fault = scripted(is_reply ? LineKind::reply : LineKind::notice, text);
  if (fault.drop) return;
  if (fault.instead) return to_gateway(*fault.instead, origin, fault.delay);
  Duration extra = fault.delay;
  if (is_reply) {
    if (strikes(faults_.drop_reply, "reply: dropped")) return;
    if (strikes(faults_.late_reply, "reply: late")) extra += milliseconds(random_.between(50, 900));
    const bool setting = text == "OK" || text == "OK_D";
    if (setting && strikes(faults_.false_ng, "reply: false NG")) text = random_.chance(0.5) ? "NG" : "NG_I";
    if (strikes(faults_.flip_reply, "line: reply flipped")) text = flipped(text);
    const bool twice = strikes(faults_.double_reply, "reply: doubled");
    to_gateway(twice ? text + "\r\n" + text + "\r\n" : text + "\r\n", origin, extra);
  } else {
    if (strikes(faults_.drop_notice, "notice: dropped")) return;
    if (strikes(faults_.late_notice, "notice: late")) extra += milliseconds(random_.between(5, 120));
    const bool twice = strikes(faults_.double_notice, "notice: doubled");
    held_notices_.emplace(now_ + extra, twice ? text + "\r\n" + text + "\r\n" : text + "\r\n");
    if (strikes(faults_.flood_notice, "notice: flood")) {
      for (int i = 0; i < random_.between(5, 20); ++i) {
        held_notices_.emplace(now_ + milliseconds(random_.between(1, 120)), text + "\r\n");
      }
    }
  }
  if (strikes(faults_.noise, "line: noise")) {
    std::string burst;
    for (int i = 0; i < random_.between(1, 6); ++i) burst += static_cast<char>(random_.between(128, 255));
    to_gateway(burst + "\r\n", {Origin::Kind::noise, 0}, {});
  }
}

// A late line holds up the ones behind it: bytes do not overtake on a wire.
void Wire::to_gateway(std::string bytes, Origin origin, Duration extra) {
  const Duration length = byte_time_ * static_cast<std::int64_t>(bytes.size());
  TimePoint at = std::max(to_gateway_free_, now_) + length + extra;
  to_gateway_free_ = at;
  if (bytes.size() > 4 && strikes(faults_.split, "line: split")) {
    // Never between the two copies of a doubled line: one that comes after the next command cannot be told from its
    // answer by anybody.
    const auto middle = bytes.size() / 2 + 1;
    in_transit_.emplace(at, Delivery{false, bytes.substr(0, middle), origin, 0});
    at += milliseconds(random_.between(1, 40));
    to_gateway_free_ = std::max(to_gateway_free_, at);
    bytes.erase(0, middle);
  }
  in_transit_.emplace(at, Delivery{false, std::move(bytes), origin, 0});
}

std::optional<TimePoint> Wire::next_event() const {
  std::optional<TimePoint> next = opens_at_;
  if (!held_notices_.empty() && (!next || held_notices_.begin()->first < *next)) next = held_notices_.begin()->first;
  if (!in_transit_.empty() && (!next || in_transit_.begin()->first < *next)) next = in_transit_.begin()->first;
  return next;
}

void Wire::advance(TimePoint now) {
  now_ = now;
  if (opens_at_ && *opens_at_ <= now) open(now);
  while (!held_notices_.empty() && held_notices_.begin()->first <= now) {
    const std::string bytes = held_notices_.extract(held_notices_.begin()).mapped();
    if (open_) to_gateway(bytes, {Origin::Kind::notice, 0}, {});
  }
  while (open_ && !in_transit_.empty() && in_transit_.begin()->first <= now) {
    const Delivery delivery = in_transit_.extract(in_transit_.begin()).mapped();
    deliver(delivery, now);
  }
}

void Wire::deliver(const Delivery& delivery, TimePoint now) {
  if (delivery.to_device) {
    if (device_reads_()) unanswered_.push_back(delivery.command);
    device_->receive(delivery.bytes, now);
    return;
  }
  note(now, "< " + escaped(delivery.bytes));
  delivering_ = delivery.origin;
  gateway_->receive(delivery.bytes, now);
  delivering_.reset();
}

}  // namespace axisgate::simulation
