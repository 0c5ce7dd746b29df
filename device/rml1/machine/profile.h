// A Profile describes a machine; it is read from a TOML file. deploy/mills has the known machines, with the source of
// each figure.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "device/config/config_error.h"
#include "device/rml1/language/dialect.h"

namespace axisgate::rml1 {

struct Speeds {
  double travel = 0, travel_z = 0;  // mm/s: X and Y with the tool up; highest speed of Z
  double cutting_minimum = 0, cutting_maximum = 0, cutting_default = 0;
  double z_minimum = 0, z_maximum = 0, z_default = 0;
};

struct Acceleration {
  double best = 0, worst = 0;  // mm/s2: the simulator uses both; the gateway computes with the worst
  double slower = 0;           // fraction by which a real run may be slower throughout
};

struct Spindle {
  enum class Law { fixed, stages, direct };
  Law law = Law::fixed;
  double minimum_rpm = 0, maximum_rpm = 0;
  std::optional<double> stage_0_rpm, rpm_per_stage;
  double spin_up_s = 0;

  // Returns the spindle speed that !RC n sets (guideline 3-3).
  double rpm(double n) const;
};

struct Rotary {
  char letter = 'A';
  bool hundredths = false;  // A1 is 0.01 degree, A1.0 is 1 degree
  double degrees_per_s = 0;
};

struct Profile {
  std::string name;
  double step_mm = 0;
  double x_mm = 0, y_mm = 0, z_mm = 0;  // the work area
  double top = 0;                       // machine coordinate of the top of travel, in steps
  int up = 1;                           // -1: machine coordinates grow downward
  double default_z0 = 0;                // machine coordinate, in steps
  double default_z1 = 0;                // steps above Z0
  std::optional<double> default_z2;     // nullopt: the top of travel
  Speeds speed;
  Acceleration acceleration;
  Spindle spindle;
  std::optional<int> baud;  // nullopt: the line is faster than the machine
  std::string axes = "XYZ";
  std::optional<Rotary> rotary;
  Dialect dialect;
  bool holds_flat_commands = false;  // D I M R PA PR PU PD stop at the edge instead of being clipped

  double steps(double mm) const { return mm / step_mm; }
};

// Reads a profile. Reports every error in the file, in the order of the lines; a syntax error ends the reading.
Configured<Profile> load_profile(const std::string& file);
// Reads a profile from text; `file` names it in errors.
Configured<Profile> parse_profile(std::string_view text, const std::string& file);

}  // namespace axisgate::rml1
