// State of a device, as the daemon last read it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "axisgate/results.h"
#include "axisgate/units.h"

namespace axisgate {

// An AxisState is the state of one axis. nullopt means unknown; a limit that is nullopt does not exist.
struct AxisState {
  int number = 0;    // from 1
  std::string name;  // from the configuration, or the number as text
  Position position;
  std::optional<bool> moving;
  std::optional<bool> motor_on;
  bool homed = false;                        // the daemon has homed the axis
  std::optional<Distance> minimum, maximum;  // travel limits from the configuration
  std::vector<std::string> conditions;       // "CW_LIMIT"
};

// A Status is the state of a device. Axes that the controller does not allow to be moved are left out.
struct AXISGATE_PUBLIC Status {
  std::string device;
  std::string link;             // "UP" if the controller answers
  std::string link_problem;     // why not; otherwise empty
  std::string mode;             // "HOST"
  std::vector<AxisState> axes;  // in the order of their numbers; empty while the controller has not answered yet

  // Returns the state of an axis by its name. Throws Unavailable while the axes are unknown, and InvalidArgument if
  // there is no such axis.
  const AxisState& axis(std::string_view name) const;
  // Returns the states of all axes. Throws Unavailable while the axes are unknown.
  const std::vector<AxisState>& known_axes() const;
  std::string text() const;
};

AXISGATE_PUBLIC std::ostream& operator<<(std::ostream& stream, const Status& status);

}  // namespace axisgate
