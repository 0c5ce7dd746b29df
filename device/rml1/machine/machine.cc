#include "device/rml1/machine/machine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace axisgate::rml1 {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();  // no edge

// Rounds to a whole number of steps if only the conversion from decimal mm caused the difference.
double snapped(double steps) {
  const double whole = std::round(steps);
  return std::abs(steps - whole) < 1e-6 ? whole : steps;
}

double jobs::Point::*part_of(char letter) {
  switch (letter) {
    case 'X':
      return &jobs::Point::x;
    case 'Y':
      return &jobs::Point::y;
    case 'Z':
      return &jobs::Point::z;
    default:
      return nullptr;
  }
}

}  // namespace

double Move::cutting_part() const {
  if (!cuts()) return 0;
  const double higher = std::max(from.z, to.z), lower = std::min(from.z, to.z);
  return higher > 0 ? lower / (lower - higher) : 1;
}

Machine::Machine(const Profile& profile, std::optional<jobs::Origin> origin, Diagnostics& diagnostics,
                 MachineListener& listener)
    : profile_(profile),
      origin_(origin),
      diagnostics_(diagnostics),
      listener_(listener),
      travel_(snapped(profile.steps(profile.z_mm))),
      z0_unsure_(origin ? 0 : travel_),
      clipper_({}, {}),
      rpm_(profile.spindle.rpm(0)) {
  z0_ = profile.top - profile.up * (origin ? snapped(profile.steps(origin->z)) : travel_);
  clipper_ = Clipper(area(), {0, 0, area().highest.z});
  commanded_ = clipper_.tool();
  set_defaults();
}

// Returns the work area. If the origin is unknown, X and Y have no edge, and Z0 may lie anywhere on the travel.
Box Machine::area() const {
  const double top = above_surface(profile_.top);
  Box box{{-kFar, -kFar, top - z0_unsure_ - travel_}, {kFar, kFar, top}};
  if (origin_) {
    box.lowest.x = -snapped(profile_.steps(origin_->x));
    box.lowest.y = -snapped(profile_.steps(origin_->y));
    box.highest.x = box.lowest.x + snapped(profile_.steps(profile_.x_mm));
    box.highest.y = box.lowest.y + snapped(profile_.steps(profile_.y_mm));
  }
  return box;
}

void Machine::execute(const Instruction& instruction) {
  const Row& row = *instruction.row;
  if (row.coordinates != Coordinates::kept) relative_ = row.coordinates == Coordinates::relative;
  perform(instruction);
  if (row.tool != Tool::kept) lowered_ = row.tool == Tool::lowered;
}

void Machine::perform(const Instruction& instruction) {
  const bool given = instruction.count > 0 && instruction.given[0];
  const double value = instruction.values[0];
  switch (instruction.row->operation) {
    case Operation::plot:
      return plot(instruction);
    case Operation::feed:
      return feed(instruction);
    case Operation::extension:
      return extension(instruction);
    case Operation::home:
      return home(instruction);
    case Operation::initialize:
      return initialize(instruction);
    case Operation::defaults:
      return set_defaults();
    case Operation::plane_speed:
      cutting_speed_ = given ? std::clamp(value, profile_.speed.cutting_minimum, profile_.speed.cutting_maximum)
                             : profile_.speed.cutting_default;
      return;
    case Operation::height_speed:
      z_speed_ =
          given ? std::clamp(value, profile_.speed.z_minimum, profile_.speed.z_maximum) : profile_.speed.z_default;
      return;
    case Operation::dwell:
      dwell_s_ = given ? value / 1000 : 0;
      return;
    case Operation::heights:
      return set_heights(instruction);
    case Operation::spindle:
      return set_spindle(instruction);
    case Operation::revolutions:
      if (given) rpm_ = profile_.spindle.rpm(value);
      return;
    case Operation::pause:
      return pause(instruction);
    case Operation::height:
      return set_height(instruction);
    case Operation::surface:
      return set_surface(instruction);
    case Operation::call:
    case Operation::ignored:
      return;
  }
}

// Executes D I M R PA PR PU PD. "PA command without parameters effects a change to the absolute-coordinate mode" (3-2),
// and moves nothing. With parameters, PA and PR go to the height of the last command that took the tool up or down
// (5-3).
void Machine::plot(const Instruction& instruction) {
  const bool keeps = instruction.row->tool == Tool::kept;
  if (keeps && instruction.count == 0) return;
  const bool lowered = keeps ? lowered_ : instruction.row->tool == Tool::lowered;
  if (instruction.first) take_tool(lowered, instruction);
  if (instruction.count == 0) return;
  jobs::Point there = clipper_.commanded();
  there.x = aim(commanded_.x, instruction.values[0]);
  there.y = aim(commanded_.y, instruction.values[1]);
  move_to(there, lowered ? cutting_speed_ : profile_.speed.travel, instruction);
}

// Dwells "just before the PD tool-down operation or just before moving the XY plane", and "just before changing from
// tool-down to tool-up with PU" (3-1 W).
void Machine::take_tool(bool lowered, const Instruction& instruction) {
  if (lowered || lowered_) dwell(instruction);
  lowered_ = lowered;
  if (lowered && !z1_set_ && !lowered_by_default_) lowered_by_default_ = instruction.place;
  commanded_.z = lowered ? z1_ : z2();
  move_height(commanded_.z, instruction);
}

void Machine::feed(const Instruction& instruction) {
  if (instruction.count == 0) return;
  if (instruction.first) dwell(instruction);
  const double before = commanded_.z;
  const jobs::Point there = {aim(commanded_.x, instruction.values[0]), aim(commanded_.y, instruction.values[1]),
                             aim(commanded_.z, instruction.values[2])};
  if (commanded_.z > before) listener_.lifted(relative_ ? instruction.values[2] : commanded_.z, instruction);
  move_to(there, z_speed_, instruction);
}

// Executes !ZE. "Axes for which nothing is specified keep their present location."
void Machine::extension(const Instruction& instruction) {
  const AxisTarget* rotation = nullptr;
  jobs::Point there = clipper_.commanded();
  bool moves = false;
  for (const AxisTarget& axis : instruction.axes) {
    if (const auto linear = profile_.axes.find(axis.letter) == std::string::npos ? nullptr : part_of(axis.letter)) {
      there.*linear = aim(commanded_.*linear, axis.value);
      moves = true;
    } else if (profile_.rotary && axis.letter == profile_.rotary->letter) {
      rotation = &axis;
    } else if (!other_axis_reported_) {
      other_axis_reported_ = true;
      diagnostics_.warn(Warning::no_such_axis, axis.place, "3-3", [&] {
        return fmt::format(
            "the {0} has no axis {1}: what the job says of it is ignored (where it has one, [rotary] belongs into its "
            "profile)",
            profile_.name, axis.letter);
      });
    }
  }
  const double lift = there.z - clipper_.commanded().z;
  if (lift > 0) listener_.lifted(relative_ ? lift : commanded_.z, instruction);
  if (instruction.first && (moves || rotation != nullptr)) dwell(instruction);
  if (moves) move_to(there, z_speed_, instruction);
  if (rotation != nullptr) turn(*rotation, instruction);
}

void Machine::turn(const AxisTarget& axis, const Instruction& instruction) {
  const double degrees = profile_.rotary->hundredths && !axis.point ? axis.value / 100 : axis.value;
  const double there = target(degrees, angle_);
  const double way = std::abs(there - angle_);
  angle_ = there;
  start_spindle(instruction);
  if (way == 0) return;
  listener_.waited(Wait::turn, way / profile_.rotary->degrees_per_s, instruction.end);
}

// Executes H: "This moves the tool to the uppermost position, then moves to the workpiece-coordinate origin point on
// the XY plane. It then stops the spindle motor." If the origin is outside, the tool goes to the nearest place inside
// (3-1 H).
void Machine::home(const Instruction& instruction) {
  const double top = box().highest.z;
  if (top > 0 && z2() <= 0) {
    diagnostics_.warn(Warning::drags_home, instruction.place, instruction.row->section, [] {
      return "goes home while Z2 = 0: a machine that goes home at Z2, and not at the top, drags the tool over the "
             "surface of the workpiece";
    });
  }
  clipper_.drive_to({tool().x, tool().y, top}, driven(profile_.speed.travel_z, instruction));
  clipper_.drive_to({0, 0, top}, driven(profile_.speed.travel, instruction));
  commanded_ = tool();
  turning_ = false;
}

// Executes IN: does the same as DF, moves the tool to its upper height, stops the spindle, and makes the present place
// the commanded one (3-2 IN).
void Machine::initialize(const Instruction& instruction) {
  // DF initializes !PZ to a value that "varies according to the model": the value may be the one that was set.
  const bool set_to_surface = z2() <= 0;
  set_defaults();
  if (box().highest.z > 0 && (z2() <= 0 || set_to_surface)) {
    diagnostics_.warn(Warning::drags_home, instruction.place, "3-2", [certain = z2() <= 0] {
      return certain ? "IN takes the tool to Z2 = 0: to the surface of the workpiece"
                     : "Z2 = 0 was set: a machine that keeps it over IN takes the tool to the surface";
    });
  }
  clipper_.drive_to({tool().x, tool().y, z2()}, driven(z_speed_, instruction));
  commanded_ = tool();
  turning_ = false;
}

void Machine::set_defaults() {
  cutting_speed_ = profile_.speed.cutting_default;
  z_speed_ = profile_.speed.z_default;
  dwell_s_ = 0;
  permitted_ = true;
  default_heights();
}

void Machine::default_heights() {
  z1_ = profile_.default_z1;
  z1_set_ = false;
  z2_ = profile_.default_z2;
}

// Sets each valid height: "If an error occurs with either Z1 or Z2, the setting is made for the one for which no error
// resulted" (3-3 !PZ).
void Machine::set_heights(const Instruction& instruction) {
  if (instruction.count == 0) return default_heights();
  if (instruction.given[0] && instruction.values[0] < box().lowest.z) {
    diagnostics_.error(3, instruction.places[0], instruction.row->section, [&] {
      return fmt::format("Z1 at {} lies below the work area, which ends at {}: it is not set", instruction.values[0],
                         box().lowest.z);
    });
  } else if (instruction.given[0]) {
    z1_ = instruction.values[0];
    z1_set_ = true;
  }
  if (instruction.count < 2 || !instruction.given[1]) return;
  z2_ = instruction.values[1];
  listener_.lifted(*z2_, instruction);
}

// Executes !MC: "When parameter n is other than 0 or when the parameter is omitted, the spindle motor is set to a
// rotatable state" (3-3 !MC).
void Machine::set_spindle(const Instruction& instruction) {
  permitted_ = instruction.count == 0 || instruction.values[0] != 0;
  if (!permitted_) turning_ = false;
}

bool Machine::reachable(double height, const Instruction& instruction) {
  const double below_top = profile_.up * (profile_.top - height);
  // A relative height counts from a Z0 that may lie higher than assumed.
  const double lowest = travel_ + (relative_ ? z0_unsure_ : 0);
  if (below_top >= 0 && below_top <= lowest) return true;
  const double bottom = profile_.top - profile_.up * travel_;
  const jobs::Place& place = instruction.count > 0 ? instruction.places[0] : instruction.place;
  diagnostics_.error(3, place, instruction.row->section, [&] {
    return fmt::format("the machine coordinate {} is outside of Z's travel, {} to {}", height,
                       std::min(profile_.top, bottom), std::max(profile_.top, bottom));
  });
  return false;
}

// Executes !ZM: "Coordinate values are specified as machine coordinates. The X and Y axes do not operate" (3-3).
void Machine::set_height(const Instruction& instruction) {
  if (instruction.count == 0) return;
  const double height = target(instruction.values[0], height_of(commanded_.z));
  const double step = std::round(height);
  if (!reachable(step, instruction)) return;
  commanded_.z = above_surface(height);
  move_height(above_surface(step), instruction);
}

void Machine::set_surface(const Instruction& instruction) {
  const bool given = instruction.count > 0;
  const double height = given ? target(instruction.values[0], height_of(commanded_.z)) : profile_.default_z0;
  if (!reachable(height, instruction)) return;
  const double shift = above_surface(height);
  take_surface(height, given && relative_);
  commanded_.z -= shift;
  clipper_.shift(-shift, area());
}

// Sets Z0. A relative height keeps the uncertainty of Z0, except for the part outside of the travel.
void Machine::take_surface(double height, bool keeps_unsure) {
  const double below_top = profile_.up * (profile_.top - height);
  const double lowest = std::min(below_top, travel_);
  const double highest = keeps_unsure ? std::max(0.0, below_top - z0_unsure_) : lowest;
  z0_ = profile_.top - profile_.up * lowest;
  z0_unsure_ = lowest - highest;
}

void Machine::pause(const Instruction& instruction) {
  diagnostics_.warn(Warning::waits_for_person, instruction.place, "3-3",
                    [] { return "!NR pauses the machine until somebody lets it go on at its panel"; });
}

// Executes ESC.K, which "ends operation of the command now being executed" (4-2): the tool's present place becomes the
// commanded one.
void Machine::quit() {
  clipper_.drive_to(tool(), [](Piece, const jobs::Point&, const jobs::Point&) {});
  commanded_ = tool();
}

// Sets the commanded coordinate of an axis, and returns it rounded to a step.
double Machine::aim(double& commanded, double value) const {
  commanded = target(value, commanded);
  return std::round(commanded);
}

void Machine::move_height(double z, const Instruction& instruction) {
  jobs::Point there = clipper_.commanded();
  there.z = z;
  move_to(there, z_speed_, instruction, true);
}

void Machine::move_to(const jobs::Point& there, double speed, const Instruction& instruction, bool height_alone) {
  start_spindle(instruction);
  listener_.commanded(clipper_.commanded(), there, height_alone, instruction);
  const bool holds = profile_.holds_flat_commands && instruction.row->operation == Operation::plot && !height_alone;
  const jobs::Point held = box().held(there);
  clipper_.move_to(holds ? jobs::Point{held.x, held.y, there.z} : there, driven(speed, instruction));
}

void Machine::dwell(const Instruction& instruction) {
  if (dwell_s_ > 0) listener_.waited(Wait::dwell, dwell_s_, instruction.end);
}

// Starts the spindle "at the time of a command that involves movement" (5-2), even if the command moves by no distance.
void Machine::start_spindle(const Instruction& instruction) {
  if (!permitted_ || turning_) return;
  turning_ = true;
  listener_.waited(Wait::spin_up, profile_.spindle.spin_up_s, instruction.end);
}

Clipper::Driven Machine::driven(double speed, const Instruction& by) {
  return [this, speed, &by](Piece piece, const jobs::Point& from, const jobs::Point& to) {
    drive(piece, from, to, speed, by);
  };
}

void Machine::drive(Piece piece, const jobs::Point& from, const jobs::Point& to, double speed, const Instruction& by) {
  if (piece == Piece::across) speed = profile_.speed.travel;
  if (piece == Piece::raise || piece == Piece::descent) speed = z_speed_;
  listener_.moved({from, to, possible(speed, to - from), lowered_ && by.row->operation == Operation::plot, turning_,
                   by.end, by.row->operation, by.place, begin_of(by)});
}

// Limits a speed to what each axis can reach.
double Machine::possible(double speed, const jobs::Point& way) const {
  const double all = length(way), plane = std::sqrt(way.x * way.x + way.y * way.y), height = std::abs(way.z);
  const double fastest = std::max(profile_.speed.travel, profile_.speed.cutting_maximum);
  if (plane > 0) speed = std::min(speed, fastest * all / plane);
  if (height > 0) speed = std::min(speed, profile_.speed.travel_z * all / height);
  return speed;
}

}  // namespace axisgate::rml1
