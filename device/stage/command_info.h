// One command of a controller's own language, described for people.
#pragma once

#include <string>
#include <vector>

#include "device/core/lane.h"

namespace axisgate::stage {

struct CommandInfo {
  std::string name;
  std::string format;  // syntax of its line, with the letters of `parameters`
  std::string description;
  std::vector<std::string> parameters;  // allowed values of each parameter, with range and unit
  std::string section;                  // section of the controller's manual, as printed there
  Lane lane = Lane::question;
  bool moves = false;  // the command may start a motion
};

}  // namespace axisgate::stage
