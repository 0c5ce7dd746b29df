// Settings of a controller other than its motion, for callers to change and read. The kind decides which of them exist,
// and their ranges.
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

// Settings of one axis. Speeds are in pulses/s.
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
struct SetSpeeds {  // absent values stay unchanged, except that S is lowered to a lower F
  int axis = 0;
  std::optional<std::int64_t> minimum{}, maximum{};
  std::optional<int> acceleration_ms{};
};
struct SetOriginSpeeds {
  int axis = 0;
  SpeedSetting speeds{};
};

// Settings of the controller.
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

// Settings that give the present position of axes another coordinate.
struct SetCoordinates {
  std::map<int, std::int64_t> pulses;  // by axis
};
struct SetOrigin {
  AxisSet axes;
};
struct UnsetOrigin {
  AxisSet axes;
};

// Actions without a lasting value.
struct FireTrigger {};
struct ResetController {};

// All axis numbers in a Setting are 1 to kAxesMax.
using Setting = std::variant<SetClosedLoop, SetExcitation, SetDivisions, SetSpeeds, SetOriginSpeeds, SetDisplay,
                             SetBeep, SetSettling, SetOutputs, SetTrigger, SetSleep, SetMode, SetFormat, SetCoordinates,
                             SetOrigin, UnsetOrigin, FireTrigger, ResetController>;

// Values that the controller reported; nullopt or empty if it did not report them.
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
