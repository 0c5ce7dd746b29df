// Simulated rotor. It reads and writes frames with separate code, so that tests detect a fault in frame.cc.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "device/stage/kind.h"

namespace axisgate::rotor {

class SimulatedRotor final : public Simulation {
 public:
  struct Options {
    std::int64_t speed = 10'000;  // pulses/s of moves and origin returns
    std::int64_t place = 5'000;   // position at power-on, from the origin
    std::int64_t serial_number = 4711;

    // Sets an option. Fails with invalid_request, which lists the options.
    Result<void> set(std::string_view name, std::string_view value);
  };

  SimulatedRotor(const Options& options, ByteLink& line);

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override { return {}; }  // the rotor sends nothing by itself

  // Executes a command of the test: "position", or "fault silent", after which the rotor obeys but does not answer
  // until "fault answering".
  Result<std::string> operate(std::string_view command, TimePoint now) override;

  std::int64_t position() const { return place_ - zero_; }
  bool busy() const { return running_ != Running::none; }

 private:
  enum class Running { none, to_target, to_origin, on };

  void take(unsigned char byte);
  void obey();
  std::int32_t set_going(Running running, std::int64_t target, std::int64_t speed);
  std::int32_t status() const;
  void answer(std::int32_t payload);

  const Options options_;
  ByteLink& line_;
  TimePoint now_{};
  std::array<unsigned char, 8> frame_{};
  std::size_t taken_ = 0;
  TimePoint last_byte_{};
  bool silent_ = false;
  bool origin_found_ = false;
  Running running_ = Running::none;
  std::int64_t place_;  // from the origin
  std::int64_t zero_;   // place of coordinate 0
  std::int64_t target_ = 0, speed_ = 0;
  TimePoint since_{};  // beginning of the motion, or of its present speed
  std::int64_t from_ = 0;
};

}  // namespace axisgate::rotor
