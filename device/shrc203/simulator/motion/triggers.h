// The trigger output (manual 97) to 101)) and ?:T (manual 42)): counts the pulses that a wire would carry.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "device/core/time.h"
#include "device/shrc203/simulator/axis_set.h"
#include "device/shrc203/simulator/motion/axis.h"

namespace axisgate::shrc203::simulator {

class Triggers {
 public:
  // Numbers as in ?:T; none after T:S and at power-on.
  enum class Target { pulses, timer, scale_plus, scale_minus, none };

  explicit Triggers(std::array<Axis, kAxes>& axes) : axes_(axes) {}

  // Triggers from `now` on: every `interval` pulses of the axis, or hundredths of a second for the timer, which ignores
  // the axis.
  void arm(Target target, int axis, std::int64_t interval, TimePoint now);
  void disarm(TimePoint now) { arm(Target::none, 1, 1, now); }
  void fire() { ++emitted_; }  // manual 100) T:M: one pulse; an armed trigger stays armed

  std::string describe() const;               // as ?:T answers
  std::int64_t emitted(TimePoint now) const;  // since construction

 private:
  std::int64_t emitted_since_armed(TimePoint now) const;

  std::array<Axis, kAxes>& axes_;
  Target target_ = Target::none;
  int axis_ = 1;
  std::int64_t interval_ = 1;
  TimePoint armed_{};
  std::int64_t emitted_ = 0;  // before the last arming, and by T:M
};

}  // namespace axisgate::shrc203::simulator
