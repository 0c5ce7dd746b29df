// What a controller is set to beside its motion, as callers change it and read it. Which of it there is, and within
// what ranges, is the kind's to say.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>

#include "device/core/time.h"
#include "device/stage/axes.h"
#include "device/stage/state.h"
#include "device/stage/trigger.h"

namespace axisgate::stage {

// Of one axis. Speeds are in pulses/s.
struct SetClosedLoop {
  int axis = 0;
  bool closed = false;
};
struct SetExcitation {
  int axis = 0;
  bool excited = false;
};
struct SetDivisions {
  int axis = 0, divisions = 0;
};
struct SetSpeeds {  // what is not given stays, but that S follows a lower F
  int axis = 0;
  std::optional<std::int64_t> minimum{}, maximum{};
  std::optional<int> acceleration_ms{};
};
struct SetOriginSpeeds {
  int axis = 0;
  SpeedSetting speeds{};
};

// Of the controller.
struct SetDisplay {
  bool lit = false;
};
struct SetBeep {
  bool on = false;
};
struct SetSettling {
  Duration settling{};
};
struct SetOutputs {
  int outputs = 0;  // as bits
};
struct SetTrigger {
  Trigger trigger;
};
struct SetSleep {
  bool sleeping = false;
};
struct SetMode {
  std::string mode;
};
struct SetFormat {
  std::string format;
};

// Another coordinate of the place where axes stand.
struct SetCoordinates {
  std::map<int, std::int64_t> pulses;  // by axis
};
struct SetOrigin {
  AxisSet axes;
};
struct UnsetOrigin {
  AxisSet axes;
};

// Done once.
struct FireTrigger {};
struct ResetController {};

// Axes in it are 1 to kAxisCount.
using Setting = std::variant<SetClosedLoop, SetExcitation, SetDivisions, SetSpeeds, SetOriginSpeeds, SetDisplay,
                             SetBeep, SetSettling, SetOutputs, SetTrigger, SetSleep, SetMode, SetFormat, SetCoordinates,
                             SetOrigin, UnsetOrigin, FireTrigger, ResetController>;

// What was reported; nothing where it was not.
struct AxisSettings {
  std::optional<bool> excited{}, closed_loop{};
  std::optional<SpeedSetting> speeds{}, origin_speeds{};
  std::optional<int> divisions{};
  std::string name_on_device{}, scale_resolution{};
};
struct Settings {
  std::map<int, AxisSettings> axes{};
  std::optional<Duration> settling{};
  std::optional<bool> sleeping{}, display_lit{}, beep{};
  std::optional<int> outputs{}, inputs{};  // as bits
  std::optional<Trigger> trigger{};
  std::optional<std::string> mode{}, format{};
};

}  // namespace axisgate::stage
