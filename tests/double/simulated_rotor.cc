#include "tests/double/simulated_rotor.h"

#include <fmt/format.h>

#include <charconv>

namespace axisgate::rotor {
namespace {

// Pause after which an incomplete frame is discarded. The bytes of a frame arrive without gaps.
constexpr Duration kFrameBreak = std::chrono::milliseconds(50);
constexpr std::int64_t kPlaceMax = 500'000'000;
constexpr std::int32_t kFirmware = 2;

enum : unsigned char { kIdentify = 1, kStatus = 2, kMove = 16, kHome = 17, kStop = 18, kJog = 19 };
enum : std::int32_t { kAccepted = 0, kBusy = 1, kTooFar = 2, kWhat = 3 };

}  // namespace

Result<void> SimulatedRotor::Options::set(std::string_view name, std::string_view value) {
  std::int64_t* into = name == "speed"           ? &speed
                       : name == "place"         ? &place
                       : name == "serial_number" ? &serial_number
                                                 : nullptr;
  if (into == nullptr) {
    return fail(Reason::invalid_request, fmt::format("a simulated rotor has no option \"{}\"", name),
                "use speed, place or serial_number");
  }
  std::int64_t number = 0;
  const char* const end = value.data() + value.size();
  const auto read = std::from_chars(value.data(), end, number);
  const std::int64_t least = name == "place" ? -kPlaceMax : 1;
  const std::int64_t most = name == "serial_number" ? 0xFFFFFF : kPlaceMax;
  if (read.ec != std::errc() || read.ptr != end || number < least || number > most) {
    return fail(Reason::invalid_request, fmt::format("\"{}\" is no {}", value, name),
                fmt::format("use a whole number from {} to {}", least, most));
  }
  *into = number;
  return {};
}

SimulatedRotor::SimulatedRotor(const Options& options, ByteLink& line)
    : options_(options), line_(line), place_(options.place), zero_(options.place) {}

void SimulatedRotor::link_up(TimePoint now) {
  advance(now);
  taken_ = 0;
}

void SimulatedRotor::link_down(TimePoint now, std::string_view) {
  advance(now);
  taken_ = 0;
}

void SimulatedRotor::receive(std::string_view bytes, TimePoint now) {
  advance(now);
  if (now - last_byte_ > kFrameBreak) taken_ = 0;
  last_byte_ = now;
  for (const char byte : bytes) take(static_cast<unsigned char>(byte));
}

void SimulatedRotor::take(unsigned char byte) {
  if (taken_ == 0 && byte != 0xA5) return;
  frame_[taken_++] = byte;
  if (taken_ < frame_.size()) return;
  taken_ = 0;
  unsigned char folded = 0;
  for (const unsigned char one : frame_) folded ^= one;
  if (folded == 0) obey();
}

void SimulatedRotor::obey() {
  std::int64_t payload = frame_[3] * 0x1000000LL + frame_[4] * 0x10000 + frame_[5] * 0x100 + frame_[6];
  if (payload >= 0x80000000LL) payload -= 0x100000000LL;
  switch (frame_[1]) {
    case kIdentify:
      return answer(kFirmware * 0x1000000 + static_cast<std::int32_t>(options_.serial_number));
    case kStatus:
      return answer(status());
    case kMove:
      if (payload > kPlaceMax || payload < -kPlaceMax) return answer(kTooFar);
      return answer(set_going(Running::to_target, zero_ + payload, options_.speed));
    case kHome:
      return answer(set_going(Running::to_origin, 0, options_.speed));
    case kStop:
      running_ = Running::none;
      return answer(kAccepted);
    case kJog:
      if (payload == 0) return answer(kTooFar);
      return answer(set_going(Running::on, 0, payload));
    default:
      return answer(kWhat);
  }
}

std::int32_t SimulatedRotor::set_going(Running running, std::int64_t target, std::int64_t speed) {
  const bool other_speed = running == Running::on && running_ == Running::on;
  if (busy() && !other_speed) return kBusy;
  if (running == Running::to_origin) origin_found_ = false;
  running_ = running;
  target_ = target;
  speed_ = running == Running::on || target >= place_ ? speed : -speed;
  since_ = now_;
  from_ = place_;
  return kAccepted;
}

std::int32_t SimulatedRotor::status() const {
  return static_cast<std::int32_t>(position() * 4 + (origin_found_ ? 2 : 0) + (busy() ? 1 : 0));
}

void SimulatedRotor::answer(std::int32_t payload) {
  if (silent_) return;
  std::string bytes(8, '\xA5');
  bytes[1] = static_cast<char>(frame_[1] + 128);
  bytes[2] = static_cast<char>(frame_[2]);
  for (std::size_t place = 6; place > 2; --place, payload >>= 8) bytes[place] = static_cast<char>(payload & 255);
  bytes[7] = 0;
  for (std::size_t place = 0; place < 7; ++place) bytes[7] = static_cast<char>(bytes[7] ^ bytes[place]);
  line_.write(bytes);
}

void SimulatedRotor::advance(TimePoint now) {
  now_ = now;
  if (!busy()) return;
  const double seconds = std::chrono::duration<double>(now - since_).count();
  place_ = from_ + static_cast<std::int64_t>(static_cast<double>(speed_) * seconds);
  const bool past = speed_ < 0 ? place_ <= target_ : place_ >= target_;
  if (running_ == Running::on || !past) return;
  place_ = target_;
  if (running_ == Running::to_origin) {
    zero_ = 0;
    origin_found_ = true;
  }
  running_ = Running::none;
}

Result<std::string> SimulatedRotor::operate(std::string_view command, TimePoint now) {
  advance(now);
  if (command == "fault silent" || command == "fault answering") {
    silent_ = command == "fault silent";
    return std::string(silent_ ? "it obeys and answers nothing" : "it answers");
  }
  if (command == "position") return fmt::format("{} pulses, {}", position(), busy() ? "moving" : "standing");
  return fail(Reason::invalid_request, fmt::format("a simulated rotor does not know \"{}\"", command),
              "use fault silent, fault answering or position");
}

}  // namespace axisgate::rotor
