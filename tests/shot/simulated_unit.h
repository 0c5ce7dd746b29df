// Simulated SHOT-1, SHOT-2 or SHOT-8. It reads and writes lines with separate code, so that tests detect a fault in the
// shared one.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "device/core/simulation.h"

namespace axisgate::shot2 {

class SimulatedUnit final : public Simulation {
 public:
  struct Options {
    std::int64_t speed = 10'000;  // pulses/s of every motion

    // Sets an option. Fails with invalid_request, which lists the options.
    Result<void> set(std::string_view name, std::string_view value);
  };

  SimulatedUnit(int axis_count, const Options& options, ByteLink& line)
      : options_(options), line_(line), axes_(static_cast<std::size_t>(axis_count)) {}

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

  // Executes a command of the test: "positions".
  Result<std::string> operate(std::string_view command, TimePoint now) override;

  std::int64_t position(int axis) const { return axis_of(axis).place; }
  bool busy(int axis) const { return axis_of(axis).arrives.has_value(); }

 private:
  struct Axis {
    std::int64_t place = 0, target = 0, from = 0;
    std::int64_t set = 0;  // target of AP:
    bool has_set = false;
    TimePoint since{};                   // start of the motion
    std::optional<TimePoint> arrives{};  // while the axis moves
  };
  Axis& axis_of(int number) { return axes_[static_cast<std::size_t>(number - 1)]; }
  const Axis& axis_of(int number) const { return axes_[static_cast<std::size_t>(number - 1)]; }

  std::vector<int> axes_in(std::string_view letter) const;
  std::string answer_to(const std::string& line);
  std::string ready() const;
  std::string set_targets(std::string_view letter, std::string_view amounts);
  std::string start(std::string_view letter, bool home);
  std::string stop(std::string_view letter);
  std::string status() const;
  void go(Axis& axis, std::int64_t target);
  void move_on(TimePoint now);

  const Options options_;
  ByteLink& line_;
  TimePoint now_{};
  std::string received_, before_ = "?:CMD";
  std::vector<Axis> axes_;
};

}  // namespace axisgate::shot2
