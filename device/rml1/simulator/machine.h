// Execution of the commands (guideline 3, 5). The drive carries out the movements.
#pragma once

#include <functional>
#include <optional>

#include "device/rml1/simulator/command.h"
#include "device/rml1/simulator/display.h"
#include "device/rml1/simulator/drive.h"
#include "device/rml1/simulator/options.h"
#include "device/rml1/simulator/route.h"
#include "device/rml1/simulator/spindle.h"

namespace axisgate::rml1::simulator {

// Z1 and Z2, in steps above Z0.
struct Heights {
  double z1 = 0;
  std::optional<double> z2;  // nullopt: the top of travel
};

// Reports to the panel.
struct PanelEvents {
  std::function<void(int number)> error;
  std::function<void()> clear_command_errors;  // H
  std::function<void()> clear_errors;          // IN
  std::function<void()> pause;                 // !NR
};

class Machine {
 public:
  // The referenced objects must outlive this one.
  Machine(const MillSetup& setup, Drive& drive, SpindleMotor& spindle, PanelEvents events);

  // Queues the command's movements at the drive. Call it while the drive is idle.
  void execute(const Order& order);

  // Call after the command in progress was ended: the next relative movement counts from the tool's present place.
  void forget_target();
  // Resets the machine at power on. The tool's place, the origin, Z0 and the heights set at the panel stay.
  void switch_on();

  // Set Z1 and Z2 at the panel.
  void set_panel_z1(double steps);
  void set_panel_z2(double steps);
  // Set the work origin, in steps from the home corner, and Z0 as a machine coordinate. Each returns false if the place
  // is outside of the area.
  bool set_origin(double x, double y);
  bool set_z0(double machine_z);

  struct Point {
    double x = 0, y = 0, z = 0;
  };
  Point workpiece(const Position& position) const;  // coordinates of PA
  bool tool_is_down() const { return tool_ == Tool::down; }

 private:
  void plot(const Order& order);
  void three_axes(const Order& order);
  void extension(const Order& order);
  void home();
  void initialize();
  void set_defaults();
  void set_dwell(const Order& order);
  void set_motor(const Order& order);
  void set_revolutions(const Order& order);
  void set_heights(const Order& order);
  void set_speed_xy(const Order& order);
  void set_speed_z(const Order& order);
  void z_move(const Order& order);
  void z_origin(const Order& order);

  void begin_motion(bool dwells);
  void go_to(const Position& target, double mm_per_s, bool flat);
  void go_to_tool_height();
  double tool_height() const;
  std::optional<double> height_from(double parameter) const;  // `parameter`: number of !ZM or !ZO
  double to_height(double machine_z) const;
  double xy_speed() const;
  Heights profile_heights() const;

  const MillSetup& setup_;
  Drive& drive_;
  SpindleMotor& spindle_;
  PanelEvents events_;
  WorkArea area_;
  Position commanded_;  // sums of relative amounts keep their fractions
  Position target_;     // the same on whole steps, unless the tool was stopped between steps
  double origin_x_ = 0, origin_y_ = 0;
  double z0_ = 0;  // height from the top, as Position::h
  Heights heights_, panel_heights_;
  bool absolute_ = true;
  Tool tool_ = Tool::up;
  double speed_xy_ = 0, speed_z_ = 0;  // mm/s
  Duration dwell_{};
};

}  // namespace axisgate::rml1::simulator
