#include "device/rml1/simulator/machine.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace axisgate::rml1::simulator {
namespace {

// Limits a coordinate: "limited to the type's maximum or minimum value" (guideline 2-5), of a float (2-3).
double coordinate(double number) { return std::clamp(number, -8388608.0, 8388607.0); }

}  // namespace

Machine::Machine(const MillSetup& setup, Drive& drive, SpindleMotor& spindle, PanelEvents events)
    : setup_(setup), drive_(drive), spindle_(spindle), events_(std::move(events)) {
  const Profile& profile = setup.profile;
  area_ = {std::round(profile.steps(profile.x_mm)), std::round(profile.steps(profile.y_mm)),
           std::round(profile.steps(profile.z_mm))};
  z0_ = to_height(profile.default_z0);
  panel_heights_ = profile_heights();
  switch_on();
}

Heights Machine::profile_heights() const { return {setup_.profile.default_z1, setup_.profile.default_z2}; }

void Machine::switch_on() {
  absolute_ = true;
  tool_ = Tool::up;
  heights_ = panel_heights_;
  speed_xy_ = setup_.profile.speed.cutting_default;
  speed_z_ = setup_.profile.speed.z_default;
  dwell_ = {};
  forget_target();
}

void Machine::forget_target() { commanded_ = target_ = drive_.planned(); }

void Machine::set_panel_z1(double steps) { heights_.z1 = panel_heights_.z1 = steps; }
void Machine::set_panel_z2(double steps) { heights_.z2 = panel_heights_.z2 = steps; }

bool Machine::set_origin(double x, double y) {
  if (!area_.holds_xy({x, y, 0})) return false;
  origin_x_ = x;
  origin_y_ = y;
  return true;
}

bool Machine::set_z0(double machine_z) {
  const double height = to_height(machine_z);
  if (height > 0 || height < -area_.depth) return false;
  z0_ = height;
  return true;
}

Machine::Point Machine::workpiece(const Position& position) const {
  return {position.x - origin_x_, position.y - origin_y_, position.h - z0_};
}

double Machine::to_height(double machine_z) const { return setup_.profile.up * (machine_z - setup_.profile.top); }

void Machine::execute(const Order& order) {
  switch (order.command->action) {
    case Action::plot:
      return plot(order);
    case Action::three_axes:
      return three_axes(order);
    case Action::extension:
      return extension(order);
    case Action::home:
      return home();
    case Action::initialize:
      return initialize();
    case Action::defaults:
      return set_defaults();
    case Action::speed_xy:
      return set_speed_xy(order);
    case Action::speed_z:
      return set_speed_z(order);
    case Action::dwell:
      return set_dwell(order);
    case Action::motor:
      return set_motor(order);
    case Action::revolutions:
      return set_revolutions(order);
    case Action::pause:
      return events_.pause();
    case Action::heights:
      return set_heights(order);
    case Action::z_move:
      return z_move(order);
    case Action::z_origin:
      return z_origin(order);
    case Action::none:
      return;
  }
}

// Executes PU PD PA PR M R D I: first the mode and the height, then X and Y (guideline 3-2 PU/PD, 5-3).
void Machine::plot(const Order& order) {
  const Command& command = *order.command;
  const bool was_down = tool_ == Tool::down;
  if (command.mode != Mode::unchanged) absolute_ = command.mode == Mode::absolute;
  if (command.tool != Tool::unchanged) tool_ = command.tool;
  // Without numbers PA and PR only change the mode.
  if (command.tool == Tool::unchanged && order.numbers.empty()) return;
  const bool down = tool_ == Tool::down;
  const bool each_point = setup_.options.is("dwell_per", "point") && down;
  begin_motion(order.first ? down || was_down : each_point);
  if (order.first) go_to_tool_height();
  if (order.numbers.empty()) return;
  const double x = absolute_ ? origin_x_ : commanded_.x;
  const double y = absolute_ ? origin_y_ : commanded_.y;
  go_to({x + coordinate(order.numbers[0]), y + coordinate(order.numbers[1]), commanded_.h}, xy_speed(), true);
}

// Starts the spindle before anything moves, even if the tool is already at its target (guideline 5-2). The dwell comes
// before the spindle (guideline 3-1 W).
void Machine::begin_motion(bool dwells) {
  if (dwells) drive_.dwell(dwell_);
  drive_.start_spindle();
}

double Machine::tool_height() const {
  if (tool_ == Tool::down) return z0_ + heights_.z1;
  return heights_.z2 ? z0_ + *heights_.z2 : 0;
}

void Machine::go_to_tool_height() { go_to({commanded_.x, commanded_.y, tool_height()}, speed_z_, true); }

double Machine::xy_speed() const { return tool_ == Tool::down ? speed_xy_ : setup_.profile.speed.travel; }

void Machine::go_to(const Position& target, double mm_per_s, bool flat) {
  const Position from = target_;
  const auto step = [](double was, double is, double reached) { return is == was ? reached : std::round(is); };
  const Position to = {step(commanded_.x, target.x, from.x), step(commanded_.y, target.y, from.y),
                       step(commanded_.h, target.h, from.h)};
  commanded_ = target;
  target_ = to;
  if (flat && setup_.profile.holds_flat_commands) return drive_.move(area_.nearest(to), mm_per_s);
  for (const Leg& leg : route(area_, from, to, drive_.planned())) {
    const double crossing = setup_.profile.speed.travel;
    const double speed = leg.kind == Leg::Kind::path ? mm_per_s : leg.kind == Leg::Kind::vertical ? speed_z_ : crossing;
    drive_.move(leg.to, speed);
  }
}

void Machine::three_axes(const Order& order) {
  if (order.numbers.empty()) return;
  begin_motion(order.first || setup_.options.is("dwell_per", "point"));
  const Position base = absolute_ ? Position{origin_x_, origin_y_, z0_} : commanded_;
  const std::vector<double>& n = order.numbers;
  go_to({base.x + coordinate(n[0]), base.y + coordinate(n[1]), base.h + coordinate(n[2])}, speed_z_, false);
}

// Ignores an axis that the machine does not have (guideline 3-3 !ZE).
void Machine::extension(const Order& order) {
  const Profile& profile = setup_.profile;
  const Position base = absolute_ ? Position{origin_x_, origin_y_, z0_} : commanded_;
  Position target = commanded_;
  bool moves = false;
  std::optional<double> degrees;
  for (const AxisNumber& axis : order.axes) {
    if (profile.rotary && axis.axis == profile.rotary->letter) {
      const bool hundredths = profile.rotary->hundredths && !axis.has_point;
      degrees = hundredths ? axis.value / 100 : axis.value;
      continue;
    }
    if (profile.axes.find(axis.axis) == std::string::npos) continue;
    moves = true;
    if (axis.axis == 'X') target.x = base.x + coordinate(axis.value);
    if (axis.axis == 'Y') target.y = base.y + coordinate(axis.value);
    if (axis.axis == 'Z') target.h = base.h + coordinate(axis.value);
  }
  if (!moves && !degrees) return;
  begin_motion(order.first || setup_.options.is("dwell_per", "point"));
  if (moves) go_to(target, speed_z_, false);
  if (!degrees) return;
  drive_.turn(absolute_ ? *degrees - drive_.planned_angle() : *degrees, profile.rotary->degrees_per_s);
}

// Moves to the top, then to the origin or the nearest point inside, then stops the spindle (guideline 3-1 H).
void Machine::home() {
  const Position at = drive_.planned();
  const Position origin = area_.nearest({origin_x_, origin_y_, 0});
  drive_.move({at.x, at.y, 0}, setup_.profile.speed.travel_z);
  drive_.move({origin.x, origin.y, 0}, setup_.profile.speed.travel);
  drive_.stop_spindle();
  tool_ = Tool::up;
  absolute_ = true;
  forget_target();
  events_.clear_command_errors();
}

void Machine::initialize() {
  set_defaults();
  tool_ = Tool::up;
  const Position at = drive_.planned();
  drive_.move(area_.nearest({at.x, at.y, tool_height()}), speed_z_);
  drive_.stop_spindle();
  forget_target();
  events_.clear_errors();
}

void Machine::set_defaults() {
  absolute_ = true;
  speed_xy_ = setup_.profile.speed.cutting_default;
  speed_z_ = setup_.profile.speed.z_default;
  dwell_ = {};
  spindle_.permit();
  heights_ = setup_.options.is("initialized_heights", "panel") ? panel_heights_ : profile_heights();
}

}  // namespace axisgate::rml1::simulator
