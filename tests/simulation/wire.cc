#include "tests/simulation/wire.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/core/escape.h"

namespace axisgate::simulation {
namespace {

constexpr std::size_t kLogLines = 120;
constexpr std::string_view kEndOfLine = "\r\n";

}  // namespace

bool sets_motion(std::string_view command) {
  const auto verb = command.substr(0, command.find(':'));
  return verb == "M" || verb == "A" || verb == "MP" || verb == "AP" || verb == "KP";
}

bool starts_motion(std::string_view command) {
  const auto verb = command.substr(0, command.find(':'));
  return verb == "G" || verb == "HRT" || verb == "ZRT";
}

void Wire::note(TimePoint now, const std::string& text) {
  log_.push_back(fmt::format("{:12.6f} {}", std::chrono::duration<double>(now.time_since_epoch()).count(), text));
  if (log_.size() > kLogLines) log_.pop_front();
}

bool Wire::strikes(double probability, const char* kind) { return random_.chance(probability) && inject(kind); }

bool Wire::strikes_newly(double probability, const char* kind) {
  return damage_random_.chance(probability) && inject(kind);
}

bool Wire::inject(const char* kind) {
  const std::uint64_t number = drawn_++;
  if (spared_.contains(number)) return false;
  ++by_kind_[kind][static_cast<std::size_t>(phase_ ? phase_() : Phase::idle)];
  note(now_, fmt::format("   fault {}: {}", number, kind));
  return true;
}

std::string Wire::flipped(std::string text, Random& random) {
  damaging_ = true;
  auto& byte = text[static_cast<std::size_t>(random.between(0, static_cast<std::int64_t>(text.size()) - 1))];
  byte = static_cast<char>(byte ^ (1 << random.between(0, 6)));
  return text;
}

std::string Wire::with_bytes_damaged(std::string text) {
  const auto place = [&] {
    return static_cast<std::size_t>(damage_random_.between(0, static_cast<std::int64_t>(text.size()) - 1));
  };
  const auto strikes_here = [&](double probability, const char* kind) {
    const bool struck = !text.empty() && strikes_newly(probability, kind);
    damaging_ = damaging_ || struck;
    return struck;
  };
  if (strikes_here(faults_.lose_byte, "line: byte lost")) text.erase(place(), 1);
  if (strikes_here(faults_.double_byte, "line: byte doubled")) {
    const auto at = place();
    text.insert(at, 1, text[at]);
  }
  if (strikes_here(faults_.eight_bit, "line: NUL or 8-bit byte")) {
    char& byte = text[place()];
    byte = damage_random_.chance(0.5) ? '\0' : static_cast<char>(byte | 0x80);
  }
  return text;
}

std::string_view Wire::end_of_line() {
  if (!strikes_newly(faults_.merge, "line: merged")) return kEndOfLine;
  damaging_ = true;
  return "";
}

void Wire::open(TimePoint now) {
  now_ = now;
  open_ = true;
  opens_at_.reset();
  device_mid_line_ = false;  // the simulator then discards an incomplete line
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

void Wire::change_gateway(LineMachine& gateway, TimePoint now, Duration until_back, bool written_is_lost) {
  now_ = now;
  note(now, "   the daemon is killed");
  gateway_ = &gateway;
  std::erase_if(in_transit_, [&](const auto& one) { return written_is_lost || !one.second.to_device; });
  opens_at_ = now + until_back;
}

void Wire::hold_up(bool to_device, Duration time) {
  TimePoint& free = to_device ? to_device_free_ : to_gateway_free_;
  free = std::max(free, now_) + time;
  for (auto& [at, delivery] : std::exchange(in_transit_, {})) {
    in_transit_.emplace(delivery.to_device == to_device ? at + time : at, std::move(delivery));
  }
}

void Wire::reopen(Duration wait) {
  note(now_, "   gateway reopens the line");
  in_transit_.clear();
  open_ = false;
  opens_at_ = now_ + wait;
}

void Wire::after_bytes(std::uint64_t count, bool of_set_and_go, std::function<void(TimePoint)> alarm) {
  alarm_bytes_ = count;
  alarm_awaits_set_ = of_set_and_go;
  alarm_ = std::move(alarm);
}

void Wire::transit(TimePoint at, Delivery delivery) {
  const std::uint64_t bytes = delivery.bytes.size();
  if (delivery.to_device && sets_motion(commands_[delivery.command])) alarm_awaits_set_ = false;
  if (alarm_awaits_set_) {
    in_transit_.emplace(at, std::move(delivery));
    return;
  }
  if (alarm_ && alarm_bytes_ <= bytes) {
    std::exchange(alarm_, {})(at - byte_time_ * static_cast<std::int64_t>(bytes - alarm_bytes_));
  } else {
    alarm_bytes_ -= std::min(alarm_bytes_, bytes);
  }
  in_transit_.emplace(at, std::move(delivery));
}

void Wire::pass_bytes(TimePoint now) {
  now_ = now;
  std::vector<Delivery> parts;
  for (auto& [at, delivery] : in_transit_) {
    const auto left = static_cast<std::size_t>((at - now + byte_time_ - Duration(1)) / byte_time_);
    // A line is whole only with all its bytes: two copies of a line arrive together.
    const std::size_t whole = std::min(delivery.bytes.size(), delivery.bytes.find(kEndOfLine));
    if (left >= delivery.bytes.size() || whole == 0) continue;
    const std::size_t come = std::min(delivery.bytes.size() - left, whole);
    Delivery part = delivery;
    part.bytes.resize(come);
    delivery.bytes.erase(0, come);
    parts.push_back(std::move(part));
  }
  for (const Delivery& part : parts) deliver(part, now);
}

// Takes one write, which is one line: the gateway never writes less or more.
void Wire::from_gateway(std::string_view bytes) {
  std::string line(bytes.substr(0, bytes.find('\r')));
  commands_.push_back(line);
  note(now_, "> " + line);
  digest_.add(now_);
  digest_.add(bytes);
  if (!open_) return;
  const Scripted fault = scripted(LineKind::command, line);
  to_device_free_ =
      std::max(to_device_free_, now_) + byte_time_ * static_cast<std::int64_t>(bytes.size()) + fault.delay;
  if (fault.drop) return;
  if (strikes(faults_.drop_command, "line: command dropped")) return;
  damaging_ = false;
  if (strikes(faults_.flip_command, "line: command flipped")) line = flipped(line, random_);
  if (strikes(faults_.null_in_command, "line: NUL in command")) line.insert(line.size() / 2, 1, '\0');
  line = with_bytes_damaged(std::move(line));
  line += end_of_line();
  if (damaging_) ++commands_damaged_;
  transit(to_device_free_, Delivery{true, fault.instead.value_or(line), {}, commands_.size() - 1, damaging_});
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

// Takes a line of the device. It answers commands in order, and answers a command that a fault has cut in two twice.
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
  damaging_ = false;
  if (!is_reply) return notice_line(std::move(text), fault.delay);
  Duration extra = fault.delay;
  if (strikes(faults_.drop_reply, "reply: dropped")) return;
  if (strikes(faults_.late_reply, "reply: late")) extra += std::chrono::milliseconds(random_.between(50, 900));
  const bool setting = text == "OK" || text == "OK_D";
  if (setting && strikes(faults_.false_ng, "reply: false NG")) text = random_.chance(0.5) ? "NG" : "NG_I";
  if (strikes(faults_.flip_reply, "line: reply flipped")) text = flipped(text, random_);
  text = with_bytes_damaged(std::move(text));
  const bool twice = strikes(faults_.double_reply, "reply: doubled");
  if (twice) text += std::string(kEndOfLine) + text;
  text += end_of_line();
  to_gateway(std::move(text), origin, extra);
  make_noise();
}

void Wire::notice_line(std::string text, Duration extra) {
  const std::string number = text + "\r\n";
  if (strikes(faults_.drop_notice, "notice: dropped")) return;
  if (strikes(faults_.late_notice, "notice: late")) extra += std::chrono::milliseconds(random_.between(5, 120));
  if (strikes_newly(faults_.flip_notice, "line: notice flipped")) text = flipped(text, damage_random_);
  text = with_bytes_damaged(std::move(text));
  const bool twice = strikes(faults_.double_notice, "notice: doubled");
  if (twice) text += std::string(kEndOfLine) + text;
  text += end_of_line();
  TimePoint at = now_ + extra;
  const bool another_waits = !held_notices_.empty() && held_notices_.begin()->first <= at;
  if (another_waits && strikes_newly(faults_.reorder_notice, "notice: reordered")) {
    at = held_notices_.begin()->first - Duration(1);
  }
  held_notices_.emplace(at, Delivery{false, text, {Origin::Kind::notice, 0}, 0, damaging_});
  if (strikes(faults_.flood_notice, "notice: flood")) {
    for (int i = 0; i < random_.between(5, 20); ++i) {
      held_notices_.emplace(now_ + std::chrono::milliseconds(random_.between(1, 120)),
                            Delivery{false, number, {Origin::Kind::notice, 0}, 0, false});
    }
  }
  make_noise();
}

void Wire::make_noise() {
  if (!strikes(faults_.noise, "line: noise")) return;
  std::string burst;
  for (int i = 0; i < random_.between(1, 6); ++i) burst += static_cast<char>(random_.between(128, 255));
  damaging_ = false;
  to_gateway(burst + "\r\n", {Origin::Kind::noise, 0}, {});
}

// Sends bytes to the gateway. A late line delays the lines after it: bytes do not overtake on a line.
void Wire::to_gateway(std::string bytes, Origin origin, Duration extra) {
  const Duration length = byte_time_ * static_cast<std::int64_t>(bytes.size());
  TimePoint at = std::max(to_gateway_free_, now_) + length + extra;
  to_gateway_free_ = at;
  if (bytes.size() > 4 && strikes(faults_.split, "line: split")) {
    // Never between the two copies of a doubled line: a copy received after the next command cannot be distinguished
    // from that command's answer.
    const auto middle = bytes.size() / 2 + 1;
    transit(at, Delivery{false, bytes.substr(0, middle), origin, 0, damaging_});
    at += std::chrono::milliseconds(random_.between(1, 40));
    to_gateway_free_ = std::max(to_gateway_free_, at);
    bytes.erase(0, middle);
  }
  transit(at, Delivery{false, std::move(bytes), origin, 0, damaging_});
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
    const Delivery held = held_notices_.extract(held_notices_.begin()).mapped();
    damaging_ = held.damaged;
    if (open_) to_gateway(held.bytes, held.origin, {});
  }
  while (open_ && !in_transit_.empty() && in_transit_.begin()->first <= now) {
    const Delivery delivery = in_transit_.extract(in_transit_.begin()).mapped();
    deliver(delivery, now);
  }
}

// Counts the lines to be answered. The device answers every line except an empty one; a flipped bit may have ended a
// line before its first character.
void Wire::expect_answers(const Delivery& delivery) {
  for (const char byte : delivery.bytes) {
    const bool end = kEndOfLine.find(byte) != std::string_view::npos;
    if (end && device_mid_line_) unanswered_.push_back(delivery.command);
    device_mid_line_ = !end && (device_mid_line_ || !(byte == ' ' || byte == '\t'));
  }
}

void Wire::deliver(const Delivery& delivery, TimePoint now) {
  if (delivery.damaged) last_damage_ = now;
  if (delivery.to_device) {
    if (device_reads_()) expect_answers(delivery);
    device_->receive(delivery.bytes, now);
    return;
  }
  if (opens_at_) return;
  note(now, "< " + escaped(delivery.bytes));
  digest_.add(now);
  digest_.add(delivery.bytes);
  delivering_ = delivery.origin;
  delivering_->damaged = delivery.damaged || unended_damage_;
  unended_damage_ = delivering_->damaged && !delivery.bytes.ends_with(kEndOfLine);
  gateway_->receive(delivery.bytes, now);
  delivering_.reset();
}

}  // namespace axisgate::simulation
