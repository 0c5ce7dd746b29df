#include "device/rml1/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace axisgate::rml1 {
namespace {

constexpr double kFar = 1e12;  // steps: no edge

// What a decimal number in mm leaves beside a whole number of steps is not meant.
double snapped(double steps) {
  const double whole = std::round(steps);
  return std::abs(steps - whole) < 1e-6 ? whole : steps;
}

}  // namespace

double Move::cutting_part() const {
  if (!cuts()) return 0;
  const double higher = std::max(from.z, to.z), lower = std::min(from.z, to.z);
  return higher > 0 ? lower / (lower - higher) : 1;
}

Machine::Machine(const Profile& profile, std::optional<Origin> origin, Diagnostics& diagnostics,
                 MachineListener& listener)
    : profile_(profile),
      origin_(origin),
      diagnostics_(diagnostics),
      listener_(listener),
      surface_known_(origin.has_value()),
      clipper_({}, {}),
      rpm_(profile.spindle.maximum_rpm) {
  const double below_top = origin ? snapped(profile.steps(origin->z)) : snapped(profile.steps(profile.z_mm));
  z0_ = profile.top - profile.up * below_top;
  clipper_ = Clipper(area(), {0, 0, area().highest.z});
  commanded_ = clipper_.tool();
  set_defaults();
}

// Where nothing is known of X and Y they have no edge; where nothing is known of Z0 it may lie anywhere on the travel.
Box Machine::area() const {
  const double travel = snapped(profile_.steps(profile_.z_mm));
  const double top = above_surface(profile_.top);
  Box box{{-kFar, -kFar, surface_known_ ? top - travel : -travel}, {kFar, kFar, top}};
  if (origin_) {
    box.lowest.x = -snapped(profile_.steps(origin_->x));
    box.lowest.y = -snapped(profile_.steps(origin_->y));
    box.highest.x = box.lowest.x + snapped(profile_.steps(profile_.x_mm));
    box.highest.y = box.lowest.y + snapped(profile_.steps(profile_.y_mm));
  }
  return box;
}

void Machine::execute(const Instruction& instruction) {
  bind(*instruction.row);
  const bool given = instruction.count > 0 && instruction.given[0];
  const double value = instruction.values[0];
  switch (instruction.row->deed) {
    case Deed::plot:
      return plot(instruction);
    case Deed::feed:
      return feed(instruction);
    case Deed::extension:
      return extension(instruction);
    case Deed::home:
      return home(instruction);
    case Deed::initialize:
      return initialize(instruction);
    case Deed::defaults:
      return set_defaults();
    case Deed::plane_speed:
      cutting_speed_ = given ? std::clamp(value, profile_.speed.cutting_minimum, profile_.speed.cutting_maximum)
                             : profile_.speed.cutting_default;
      return;
    case Deed::height_speed:
      z_speed_ =
          given ? std::clamp(value, profile_.speed.z_minimum, profile_.speed.z_maximum) : profile_.speed.z_default;
      return;
    case Deed::dwell:
      dwell_s_ = given ? value / 1000 : 0;
      return;
    case Deed::heights:
      return set_heights(instruction);
    case Deed::spindle:
      return set_spindle(instruction);
    case Deed::revolutions:
      if (given) rpm_ = profile_.spindle.rpm(value);
      return;
    case Deed::pause:
      return pause(instruction);
    case Deed::height:
      return set_height(instruction);
    case Deed::surface:
      return set_surface(instruction);
    case Deed::call:
    case Deed::ignored:
      return;
  }
}

void Machine::bind(const Row& row) {
  if (row.coordinates != Coordinates::kept) relative_ = row.coordinates == Coordinates::relative;
}

// D I M R PA PR PU PD. "PA command without parameters effects a change to the absolute-coordinate mode" (3-2), and
// moves nothing; with parameters PA and PR go to the height of the last command that took the tool up or down (5-3).
void Machine::plot(const Instruction& instruction) {
  const bool keeps = instruction.row->tool == Tool::kept;
  if (keeps && instruction.count == 0) return;
  const bool lowered = keeps ? lowered_ : instruction.row->tool == Tool::lowered;
  if (instruction.first) take_tool(lowered, instruction);
  if (instruction.count == 0) return;
  Point there = clipper_.commanded();
  there.x = aim(commanded_.x, instruction.values[0]);
  there.y = aim(commanded_.y, instruction.values[1]);
  if (profile_.holds_flat_commands) {
    const Point held = box().held(there);
    there = {held.x, held.y, there.z};
  }
  move_to(there, lowered ? cutting_speed_ : profile_.speed.travel, instruction);
}

// Dwell: "just before the PD tool-down operation or just before moving the XY plane", and "just before changing from
// tool-down to tool-up with PU" (3-1 W).
void Machine::take_tool(bool lowered, const Instruction& instruction) {
  if (lowered || lowered_) dwell();
  lowered_ = lowered;
  commanded_.z = lowered ? z1_ : z2();
  move_height(z_speed_, instruction);
}

void Machine::feed(const Instruction& instruction) {
  if (instruction.count == 0) return;
  if (instruction.first) dwell();
  const double before = commanded_.z;
  const Point there = {aim(commanded_.x, instruction.values[0]), aim(commanded_.y, instruction.values[1]),
                       aim(commanded_.z, instruction.values[2])};
  if (commanded_.z > before) listener_.lifted(relative_ ? instruction.values[2] : commanded_.z, instruction);
  move_to(there, z_speed_, instruction);
}

// !ZE. "Axes for which nothing is specified keep their present location."
void Machine::extension(const Instruction& instruction) {
  if (instruction.first) dwell();
  const AxisTarget* rotation = nullptr;
  Point there = clipper_.commanded();
  for (const AxisTarget& axis : instruction.axes) {
    const bool here = profile_.axes.find(axis.letter) != std::string::npos;
    if (here && axis.letter == 'X') {
      there.x = aim(commanded_.x, axis.value);
    } else if (here && axis.letter == 'Y') {
      there.y = aim(commanded_.y, axis.value);
    } else if (here && axis.letter == 'Z') {
      there.z = aim(commanded_.z, axis.value);
    } else if (profile_.rotary && axis.letter == profile_.rotary->letter) {
      rotation = &axis;
    } else if (!other_axis_told_) {
      other_axis_told_ = true;
      diagnostics_.add(0, Severity::warning, axis.place, "3-3", [&] {
        return fmt::format("the {} has no axis {}: what is told of it is ignored", profile_.name, axis.letter);
      });
    }
  }
  move_to(there, z_speed_, instruction);
  if (rotation != nullptr) turn(*rotation, instruction);
}

void Machine::turn(const AxisTarget& axis, const Instruction& instruction) {
  const double degrees = profile_.rotary->hundredths && !axis.point ? axis.value / 100 : axis.value;
  const double there = target(degrees, angle_);
  const double way = std::abs(there - angle_);
  angle_ = there;
  if (way == 0) return;
  Move beside{.from = tool(),
              .to = tool(),
              .lowered = lowered_,
              .turning = turning_,
              .end = instruction.end,
              .row = instruction.row,
              .place = instruction.place};
  listener_.turned(way / profile_.rotary->degrees_per_s, beside);
}

// "This moves the tool to the uppermost position, then moves to the workpiece-coordinate origin point on the XY plane.
// It then stops the spindle motor." Where the origin is outside, to the nearest place (3-1 H).
void Machine::home(const Instruction& instruction) {
  const double top = box().highest.z;
  clipper_.drive_to({tool().x, tool().y, top}, driven(profile_.speed.travel_z, instruction, false));
  clipper_.drive_to({0, 0, top}, driven(profile_.speed.travel, instruction, false));
  commanded_ = tool();
  lowered_ = false;
  turning_ = false;
}

// As DF, the tool to its upper height, the spindle stops, and the present place is the commanded one (3-2 IN).
void Machine::initialize(const Instruction& instruction) {
  set_defaults();
  if (z2() <= 0) {
    diagnostics_.add(0, Severity::warning, instruction.place, "3-2", [] {
      return "IN takes the tool to Z2, which is no height above Z0: it comes down to the surface";
    });
  }
  clipper_.drive_to({tool().x, tool().y, z2()}, driven(z_speed_, instruction, false));
  commanded_ = tool();
  lowered_ = false;
  turning_ = false;
}

void Machine::set_defaults() {
  relative_ = false;
  cutting_speed_ = profile_.speed.cutting_default;
  z_speed_ = profile_.speed.z_default;
  dwell_s_ = 0;
  permitted_ = true;
  z1_ = profile_.default_z1;
  z2_ = profile_.default_z2;
}

// "If an error occurs with either Z1 or Z2, the setting is made for the one for which no error resulted" (3-3 !PZ).
void Machine::set_heights(const Instruction& instruction) {
  if (instruction.count == 0) {
    z1_ = profile_.default_z1;
    z2_ = profile_.default_z2;
    return;
  }
  if (instruction.given[0] && instruction.values[0] < box().lowest.z) {
    diagnostics_.error(3, instruction.places[0], instruction.row->section, [&] {
      return fmt::format("Z1 at {} lies below the work area, which ends at {}: it is not set", instruction.values[0],
                         box().lowest.z);
    });
  } else if (instruction.given[0]) {
    z1_ = instruction.values[0];
  }
  if (instruction.count < 2 || !instruction.given[1]) return;
  z2_ = instruction.values[1];
  listener_.lifted(*z2_, instruction);
}

// "When parameter n is other than 0 or when the parameter is omitted, the spindle motor is set to a rotatable state"
// (3-3 !MC).
void Machine::set_spindle(const Instruction& instruction) {
  permitted_ = instruction.count == 0 || instruction.values[0] != 0;
  if (!permitted_) turning_ = false;
}

bool Machine::within_travel(double height, const Instruction& instruction) {
  const double below_top = profile_.up * (profile_.top - height);
  const double travel = snapped(profile_.steps(profile_.z_mm));
  if (below_top >= 0 && below_top <= travel) return true;
  const double bottom = profile_.top - profile_.up * travel;
  diagnostics_.error(3, instruction.places[0], instruction.row->section, [&] {
    return fmt::format("the machine coordinate {} is outside of Z's travel, {} to {}", height,
                       std::min(profile_.top, bottom), std::max(profile_.top, bottom));
  });
  return false;
}

// !ZM. "Coordinate values are specified as machine coordinates. The X and Y axes do not operate" (3-3).
void Machine::set_height(const Instruction& instruction) {
  if (instruction.count == 0) return;
  const double height = target(instruction.values[0], height_of(commanded_.z));
  if (!within_travel(height, instruction)) return;
  commanded_.z = above_surface(height);
  move_height(z_speed_, instruction);
}

void Machine::set_surface(const Instruction& instruction) {
  const bool given = instruction.count > 0;
  const double height = given ? target(instruction.values[0], height_of(commanded_.z)) : profile_.default_z0;
  if (!within_travel(height, instruction)) return;
  const double shift = profile_.up * (z0_ - height);
  z0_ = height;
  surface_known_ = surface_known_ || !given || !relative_;
  commanded_.z += shift;
  clipper_.shift(shift, area());
}

void Machine::pause(const Instruction& instruction) {
  diagnostics_.add(0, Severity::warning, instruction.place, "3-3",
                   [] { return "!NR pauses the machine until somebody lets it go on at its panel"; });
}

// "ends operation of the command now being executed" (4-2): the machine stands where the tool is.
void Machine::quit() { commanded_ = tool(); }

// Sets where an axis is commanded to, and tells the step that this means.
double Machine::aim(double& commanded, double value) const {
  commanded = target(value, commanded);
  return std::round(commanded);
}

void Machine::move_height(double speed, const Instruction& instruction) {
  Point there = clipper_.commanded();
  there.z = std::round(commanded_.z);
  move_to(there, speed, instruction);
}

void Machine::move_to(const Point& there, double speed, const Instruction& instruction) {
  listener_.commanded(there, instruction);
  clipper_.move_to(there, driven(speed, instruction));
}

void Machine::dwell() {
  if (dwell_s_ > 0) listener_.dwelt(dwell_s_);
}

Clipper::Driven Machine::driven(double speed, const Instruction& by, bool starts_spindle) {
  return [this, speed, &by, starts_spindle](Piece piece, const Point& from, const Point& to) {
    drive(piece, from, to, speed, by, starts_spindle);
  };
}

void Machine::drive(Piece piece, const Point& from, const Point& to, double speed, const Instruction& by,
                    bool starts_spindle) {
  // "the spindle motor is made to rotate from a stopped state, and then the movement is performed" (3-3 !MC).
  if (starts_spindle && permitted_ && !turning_) {
    turning_ = true;
    listener_.spun_up(profile_.spindle.spin_up_s);
  }
  if (piece == Piece::along) speed = z_speed_;  // "at the speed set by the !ZZ command" (5-1 E, J)
  if (piece == Piece::across) speed = profile_.speed.travel;
  if (piece == Piece::raise || piece == Piece::descent) speed = z_speed_;
  listener_.moved({from, to, possible(speed, to - from), lowered_ && by.row->deed == Deed::plot, turning_, by.end,
                   by.row, by.place});
}

// No axis goes faster than it can.
double Machine::possible(double speed, const Point& way) const {
  const double all = length(way), plane = std::sqrt(way.x * way.x + way.y * way.y), height = std::abs(way.z);
  const double fastest = std::max(profile_.speed.travel, profile_.speed.cutting_maximum);
  if (plane > 0) speed = std::min(speed, fastest * all / plane);
  if (height > 0) speed = std::min(speed, profile_.speed.travel_z * all / height);
  return speed;
}

}  // namespace axisgate::rml1
