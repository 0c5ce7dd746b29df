// The grammar of replies. A row's `reply` names the fields in order, separated by commas: `ready*` is one R or B per
// axis, `number:0:63` is a number in that range. OK, NG and NG_I are possible for every row (manual 3.).
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/quantity.h"
#include "device/shot/command/model.h"
#include "device/shot/command/status.h"
#include "device/shot/stage.h"

namespace axisgate::shot {

struct Reply {
  enum class Kind { ok, ok_d, ng, ng_i, data };
  Kind kind = Kind::data;
  std::string text;                 // whole line
  std::vector<std::string> fields;  // fields of data, without the blanks after commas

  bool accepted() const { return kind == Kind::ok || kind == Kind::ok_d; }
};

// Returns nullopt if `line` cannot be an answer to `row` from a unit of the model with `axis_count` controllable axes
// (0: not known yet, any number from 1 to the model's).
std::optional<Reply> parse_reply(const Model& model, const CommandRow& row, std::string_view line, int axis_count);

// Range of a single bare number as an answer to `row`, for one axis or in total; nullopt if the answer is never a bare
// number.
struct NumberRange {
  std::int64_t minimum, maximum;
};
std::optional<NumberRange> bare_number_range(const CommandRow& row);

struct Identity {
  std::string vendor, model, serial_number, firmware;
  friend bool operator==(const Identity&, const Identity&) = default;
};
std::optional<Identity> parse_identity(std::string_view line);  // four fields (manual 1))

// Returns the fields of an answer to a question for all axes, by axis. Only controllable axes are included, also if the
// answer has 0 and D for the others (manual 5)). Empty if the number of fields is neither all axes nor the controllable
// ones.
std::map<int, std::string> by_axis(const Model& model, const Reply& reply, AxisSet controllable);

struct AxisReading {
  bool valid = false;  // the axis is controllable
  std::int64_t pulses = 0;
  AxisStatusBits status;
  bool busy = false;
};
// Parses a reply to Q:SPC (manual 5)), in pulses: a reading of each axis of the model, in order. `controllable` assigns
// the fields if the reply leaves invalid axes out.
std::optional<std::vector<AxisReading>> parse_positions(const Model& model, const Reply& reply, AxisSet controllable);

// Parses S100F1000R50. nullopt for numbers outside the ranges of manual 89) D:, which only a disturbed line reports.
std::optional<SpeedSetting> parse_speed_setting(std::string_view field);

std::optional<std::int64_t> parse_integer(std::string_view text);

}  // namespace axisgate::shot
