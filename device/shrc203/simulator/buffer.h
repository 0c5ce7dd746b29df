// The execution buffer and the prebuffer (manual 2): settings that a G starts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "device/shrc203/simulator/axis_set.h"
#include "device/shrc203/simulator/motion/motion_profile.h"
#include "device/shrc203/simulator/units.h"

namespace axisgate::shrc203::simulator {

enum class Kind {
  relative,
  absolute,
  line,
  arc,
  jog,
  wait_time,
  wait_input,
  origin_return,
  logical_return,
  saved_position,
};

// E:0 to E:5 (manual 71) to 76)). Points in pulses, in the order of the command.
struct Arc {
  int shape = 0;
  int direction = 0;
  std::optional<int> turns;
  std::optional<Number> angle;
  std::vector<std::int64_t> points;
};

struct Setting {
  Kind kind = Kind::relative;
  Axes axes;
  // Value of each axis: displacement in pulses, target coordinate, sign of a jog, tenths of a second, or the inputs
  // waited for.
  std::array<std::int64_t, kAxes> values{};
  // Speeds that overwrite D:, at the start for MP: and similar commands, at the end of the jog for JD:.
  std::array<std::optional<Speed>, kAxes> speeds;
  std::optional<Arc> arc;
  char letter = ' ';  // axis letter of a line or arc, as sent

  bool is_prebuffer = false;  // set by a command of section 2: its end sends the axis number
  bool chains = false;        // starts without a G when its axes are free

  bool indivisible() const { return kind == Kind::line || kind == Kind::arc; }
  Setting only(int axis) const;
};

class Buffer {
 public:
  // Stores a setting. It overwrites other settings of its axes.
  void put(Setting setting);

  // Removes the axes from all settings. A line or an arc that uses one of them is removed as a whole.
  void disconnect(const Axes& axes);
  void clear() { settings_.clear(); }

  // Splits each setting that has named and other axes into two, except a line or an arc.
  void split(const Axes& axes);

  const Setting* find(Kind kind, int axis) const;
  const Setting* find(Kind kind) const;
  std::vector<Setting>& settings() { return settings_; }
  const std::vector<Setting>& settings() const { return settings_; }

 private:
  std::vector<Setting> settings_;  // no two settings share an axis
};

}  // namespace axisgate::shrc203::simulator
