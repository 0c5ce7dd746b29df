// One command of a controller's own language, described for people.
#pragma once

#include <string>
#include <vector>

#include "device/core/lane.h"

namespace axisgate::stage {

struct CommandInfo {
  std::string name;
  std::string format;  // how its line is written, with the letters of `parameters`
  std::string description;
  std::vector<std::string> parameters;  // what each may be, with range and unit
  std::string section;                  // of the controller's manual, as it stands there
  Lane lane = Lane::question;
  bool moves = false;  // it may set something moving
};

}  // namespace axisgate::stage
