#include "device/shrc203/simulator/motion/triggers.h"

#include <fmt/format.h>

#include "device/shrc203/simulator/commands/setters.h"

namespace axisgate::shrc203::simulator {
namespace {

constexpr Duration kTimerUnit = std::chrono::milliseconds(10);

// T:PaPb and T:EaPmb.
Answer arm_on_axis(Rig& rig, Reader reader, bool scale) {
  const auto number = reader.take_digit(kAxes);
  if (!number || *number == 0 || !rig.controllable.has(*number) || !reader.take('P')) return Answer::ng;
  // "Sign cannot be omitted" (manual 101)); drive pulses count in both directions and have no sign (manual 98)).
  const bool minus = scale && reader.take('-');
  if (scale && !minus && !reader.take('+')) return Answer::ng;
  const auto interval = reader.take_integer(2, 30'000);
  if (!interval || !reader.done()) return Answer::ng;
  using Target = Triggers::Target;
  const Target target = !scale ? Target::pulses : minus ? Target::scale_minus : Target::scale_plus;
  rig.triggers.arm(target, *number, *interval, rig.now);
  return Answer::ok;
}

Answer arm_timer(Rig& rig, Reader reader) {
  const auto interval = reader.take_integer(1, 10'000);
  if (!interval || !reader.done()) return Answer::ng;
  rig.triggers.arm(Triggers::Target::timer, 1, *interval, rig.now);
  return Answer::ok;
}

Answer trigger(Rig& rig, Reader reader) {
  if (rig.motions.busy(rig.controllable)) return Answer::ng;
  if (reader.rest() == "S") {
    rig.triggers.disarm(rig.now);
    return Answer::ok;
  }
  if (reader.rest() == "M") {
    rig.triggers.fire();
    return Answer::ok;
  }
  if (reader.take('T')) return arm_timer(rig, reader);
  if (reader.take('P')) return arm_on_axis(rig, reader, false);
  return reader.take('E') ? arm_on_axis(rig, reader, true) : Answer::ng;
}

constexpr Command kCommand{"T:", trigger};

}  // namespace

void Triggers::arm(Target target, int axis, std::int64_t interval, TimePoint now) {
  emitted_ += emitted_since_armed(now);
  target_ = target;
  axis_ = axis;
  interval_ = interval;
  armed_ = now;
  axes_[index_of(axis)].start_mileage();
}

std::string Triggers::describe() const {
  const int number = static_cast<int>(target_);
  switch (target_) {
    case Target::none:
      return "NS";
    case Target::timer:
      return fmt::format("{},{}", number, interval_);
    case Target::pulses:
    case Target::scale_plus:
      return fmt::format("{},{},{}", number, axis_, interval_);
    case Target::scale_minus:
      break;
  }
  return fmt::format("{},{},{}", number, axis_, -interval_);
}

std::int64_t Triggers::emitted(TimePoint now) const { return emitted_ + emitted_since_armed(now); }

// Manual 101): passing the same position again, back and forth, gives no second trigger.
std::int64_t Triggers::emitted_since_armed(TimePoint now) const {
  const Mileage gone = axes_[index_of(axis_)].mileage(now);
  switch (target_) {
    case Target::pulses:
      return gone.total / interval_;
    case Target::timer:
      return (now - armed_) / (kTimerUnit * interval_);
    case Target::scale_plus:
      return gone.highest / interval_;
    case Target::scale_minus:
      return -gone.lowest / interval_;
    case Target::none:
      break;
  }
  return 0;
}

const Command* find_trigger_command(std::string_view verb) { return verb == kCommand.verb ? &kCommand : nullptr; }

}  // namespace axisgate::shrc203::simulator
