// Commands that set a value, and commands with machine coordinates of Z. They judge the number as written, instead of
// limiting it like a coordinate.
#include <algorithm>
#include <chrono>
#include <cmath>

#include "device/rml1/simulator/machine.h"

namespace axisgate::rml1::simulator {
namespace {

constexpr int kError3 = 3;                                   // guideline 3
constexpr double kIntMinimum = -32768, kIntMaximum = 32767;  // guideline 2-3
constexpr double kLongMaximum = 8388607;                     // guideline 2-3

}  // namespace

// "No error is generated" (guideline 3-1 F).
void Machine::set_speed_xy(const Order& order) {
  const Speeds& speed = setup_.profile.speed;
  const double wanted = order.numbers.empty() ? speed.cutting_default : order.numbers[0];
  speed_xy_ = std::clamp(wanted, speed.cutting_minimum, speed.cutting_maximum);
}

void Machine::set_speed_z(const Order& order) {
  const Speeds& speed = setup_.profile.speed;
  const double wanted = order.numbers.empty() ? speed.z_default : order.numbers[0];
  if (wanted < kIntMinimum || wanted > kIntMaximum) return events_.error(kError3);
  speed_z_ = std::clamp(wanted, speed.z_minimum, speed.z_maximum);
}

void Machine::set_dwell(const Order& order) {
  const double wanted = order.numbers.empty() ? 0 : order.numbers[0];
  if (wanted < 0 || wanted > kIntMaximum) return events_.error(kError3);
  dwell_ = std::chrono::milliseconds(std::llround(std::trunc(wanted)));
}

void Machine::set_motor(const Order& order) {
  const bool off = order.command->name == "!0" || (!order.numbers.empty() && std::trunc(order.numbers[0]) == 0);
  if (off) {
    spindle_.forbid();
  } else {
    spindle_.permit();
  }
}

void Machine::set_revolutions(const Order& order) {
  if (order.numbers.empty()) return;
  const double wanted = order.numbers[0];
  if (wanted < 0 || wanted > kLongMaximum) return events_.error(kError3);
  spindle_.set_revolutions(std::trunc(wanted));
}

// Executes @ and !PZ. Each of the two numbers is judged separately (guideline 3-1 @, 3-3 !PZ).
void Machine::set_heights(const Order& order) {
  const std::vector<double>& numbers = order.numbers;
  if (numbers.empty()) {
    const bool from_panel = order.command->name == "@" && setup_.options.is("at_without_numbers", "panel");
    heights_ = from_panel ? panel_heights_ : profile_heights();
    return;
  }
  const double z1 = std::trunc(numbers[0]);
  if (numbers[0] > 0 || z0_ + z1 < -area_.depth) {
    events_.error(kError3);
  } else {
    heights_.z1 = z1;
  }
  if (numbers.size() < 2) return;
  if (numbers[1] < 0) return events_.error(kError3);
  heights_.z2 = std::trunc(std::min(numbers[1], kLongMaximum));
}

// Returns nullopt if the height is not within Z's travel.
std::optional<double> Machine::height_from(double parameter) const {
  const double whole = std::trunc(parameter);
  const double height = absolute_ ? to_height(whole) : commanded_.h + setup_.profile.up * whole;
  if (height > 0 || height < -area_.depth) return std::nullopt;
  return height;
}

void Machine::z_move(const Order& order) {
  if (order.numbers.empty()) return;
  const auto height = height_from(order.numbers[0]);
  if (!height) return events_.error(kError3);
  begin_motion(false);
  go_to({commanded_.x, commanded_.y, *height}, speed_z_, false);
}

void Machine::z_origin(const Order& order) {
  if (order.numbers.empty()) {
    z0_ = to_height(setup_.profile.default_z0);
    return;
  }
  const auto height = height_from(order.numbers[0]);
  if (!height) return events_.error(kError3);
  z0_ = std::round(*height);
}

}  // namespace axisgate::rml1::simulator
