// One exchange in flight: what waits for the line, the time limit of an answer, its repeats, and the line's loss.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/lane.h"
#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/stage/event.h"
#include "device/stage/motion.h"
#include "tests/double/frame.h"

namespace axisgate::rotor {

inline constexpr Duration kReplyLimit = std::chrono::milliseconds(300);
inline constexpr int kRepeats = 3;
inline constexpr Duration kReopenMin = std::chrono::milliseconds(250), kReopenMax = std::chrono::seconds(5);

// What became of a question or command.
struct Answer {
  std::optional<std::int32_t> payload;
  bool written = false;
  std::optional<Problem> problem;  // without a payload
};

struct Asked {
  Opcode opcode = Opcode::status;
  std::int32_t payload = 0;
  Lane lane = Lane::question;
  std::string who;
  TimePoint not_after{};
  stage::MotionId motion = 0;  // whose it is; 0: none's
  std::function<void(const Answer&)> done;

  bool question() const { return opcode <= Opcode::status; }
  // Whatever may set the rotor going is written once.
  bool repeatable() const { return question() || opcode == Opcode::stop; }
};

class Wire {
 public:
  class Listener {
   public:
    virtual ~Listener() = default;
    // The last look before the bytes of a motion go out; they do where nothing is returned.
    virtual std::optional<Problem> may_write(const Asked& asked) = 0;
    virtual void wire_open() = 0;
    virtual void wire_lost(const std::string& why) = 0;
    virtual void wire_event(const stage::Event& event) = 0;
  };

  Wire(ByteLink& link, Listener& listener) : link_(link), listener_(listener) {}

  // Each is answered once, from within a later call; only withdraw() and seal() leave none.
  void ask(Asked asked, TimePoint now);
  void withdraw(stage::MotionId motion);
  void seal();

  // Writes the next where nothing is in flight; whether anything happened.
  bool pump(TimePoint now);
  void link_up(TimePoint now);
  // The line was lost, or is no good: stops go on waiting, all else is answered.
  void lose(const std::string& why, TimePoint now);
  void receive(std::string_view bytes, TimePoint now);
  void advance(TimePoint now);
  std::optional<TimePoint> next_deadline() const;

  void proved_good() { reopen_wait_ = kReopenMin; }
  bool exchanging() const { return in_flight_.has_value(); }
  std::size_t queued(Lane lane) const { return queues_[static_cast<std::size_t>(lane)].size(); }

 private:
  struct Waiting {
    Asked asked;
    TimePoint since{};
    int tries = 0;
  };
  struct InFlight {
    Waiting what;
    std::uint8_t sequence = 0;
    std::uint64_t exchange = 0;
    std::string bytes;
    TimePoint written{};
  };

  std::optional<Waiting> take_next();
  void write(Waiting next, TimePoint now);
  void answered(const Frame& frame, TimePoint now);
  void timed_out(TimePoint now);
  void expire(TimePoint now);
  void tell_end(const InFlight& ended, stage::ExchangeEnded::Outcome outcome, std::string reply, TimePoint now);

  ByteLink& link_;
  Listener& listener_;
  FrameParser parser_;
  bool open_ = false;
  std::array<std::deque<Waiting>, kLaneCount> queues_;
  std::optional<InFlight> in_flight_;
  std::uint8_t sequence_ = 0;
  std::uint64_t exchanges_ = 0;
  Duration reopen_wait_ = kReopenMin;
};

}  // namespace axisgate::rotor
