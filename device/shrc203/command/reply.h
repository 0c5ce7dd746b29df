// The replies' grammar. A row's `reply` names its fields in order, separated by commas: `ready*` is one R or B per
// axis, `number:0:63` a number in that range. OK, NG and NG_I are possible for every row (manual 3.).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/quantity.h"
#include "device/shrc203/command/command_table.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203 {

struct Reply {
  enum class Kind { ok, ok_d, ng, ng_i, data };
  Kind kind = Kind::data;
  std::string text;                 // the whole line
  std::vector<std::string> fields;  // of data; blanks after commas removed

  bool accepted() const { return kind == Kind::ok || kind == Kind::ok_d; }
};

// Nothing where `line` cannot be an answer to `row` from a controller with `axis_count` controllable axes (0: not known
// yet, any count from 1 to 3).
std::optional<Reply> parse_reply(const CommandRow& row, std::string_view line, int axis_count);

// The range of a single bare number as an answer to `row`, per axis or whole; nothing where it can never be one.
struct NumberRange {
  std::int64_t minimum, maximum;
};
std::optional<NumberRange> bare_number_range(const CommandRow& row);

struct Identity {
  std::string vendor, model, serial_number, firmware;
  friend bool operator==(const Identity&, const Identity&) = default;
};
std::optional<Identity> parse_identity(std::string_view line);  // four fields (manual 1))

// The fields of an answer to a question for all axes, by axis: of the controllable ones, also where the others stay as
// 0 and D (manual 5)). Nothing where there are as many as neither.
std::map<int, std::string> by_axis(const Reply& reply, AxisSet controllable);

struct AxisReading {
  bool valid = false;  // the axis is controllable
  std::int64_t pulses = 0;
  AxisStatusBits status;
  bool busy = false;
};
// A reply to Q:SPC (manual 5)), in pulses: three readings, in axis order. `controllable` places the fields of a reply
// that leaves invalid axes out.
std::optional<std::vector<AxisReading>> parse_positions(const Reply& reply, AxisSet controllable);

// S100F1000R50. Nothing for numbers outside the ranges of manual 89) D:, which only a disturbed line reports.
std::optional<SpeedSetting> parse_speed_setting(std::string_view field);

std::optional<std::int64_t> parse_integer(std::string_view text);

}  // namespace axisgate::shrc203
