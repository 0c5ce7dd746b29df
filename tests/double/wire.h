// Line to a rotor with one exchange in flight: queues, time limit of answers, repeats, and loss of the line.
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

// Result of a question or command.
struct Answer {
  std::optional<std::int32_t> payload;
  bool written = false;
  std::optional<Problem> problem;  // present if there is no payload
};

struct Asked {
  Opcode opcode = Opcode::status;
  std::int32_t payload = 0;
  Lane lane = Lane::question;
  std::string who;
  TimePoint not_after{};
  stage::MotionId motion = 0;  // motion that it belongs to; 0: none
  std::function<void(const Answer&)> done;

  bool question() const { return opcode <= Opcode::status; }
  // Reports whether it may be written again. A command that may start the rotor is written only once.
  bool repeatable() const { return question() || opcode == Opcode::stop; }
};

class Wire {
 public:
  class Listener {
   public:
    virtual ~Listener() = default;
    // Called just before the bytes of a motion are written. They are written only if it returns nullopt.
    virtual std::optional<Problem> may_write(const Asked& asked) = 0;
    virtual void wire_open() = 0;
    virtual void wire_lost(const std::string& why) = 0;
    virtual void wire_event(const stage::Event& event) = 0;
  };

  Wire(ByteLink& link, Listener& listener) : link_(link), listener_(listener) {}

  // Queues a question or command. It is answered once, from within a later call, unless withdraw() or seal() removes
  // it.
  void ask(Asked asked, TimePoint now);
  void withdraw(stage::MotionId motion);
  void seal();

  // Writes the next one if nothing is in flight. Reports whether anything happened.
  bool pump(TimePoint now);
  void link_up(TimePoint now);
  // Handles a lost or unusable line: stops keep waiting, all other requests are answered.
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
