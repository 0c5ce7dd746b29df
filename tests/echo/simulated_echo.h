// An echo machine without its hardware.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/simulation.h"

namespace axisgate::echo {

class SimulatedEcho final : public Simulation {
 public:
  explicit SimulatedEcho(ByteLink& line) : line_(line) {}

  void link_up(TimePoint) override {}
  void link_down(TimePoint, std::string_view) override {}
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override { return due_; }
  Result<std::string> operate(std::string_view command, TimePoint now) override;

 private:
  void begin_next(TimePoint now);

  ByteLink& line_;
  std::string received_;
  std::deque<std::string> lines_;
  std::optional<TimePoint> due_;  // of the first of lines_
  std::size_t executed_ = 0;
};

}  // namespace axisgate::echo
