// The formats of command_table.h: how a line is put together from its parameters, and taken apart again.
//
//   text    stands for itself                  <a>     a parameter of the row, by its letter in the manual
//   [...]   may be left out                    {...|s} once for each axis of <a>, `s` between two
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/problem.h"
#include "device/shrc203/command/axes.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {

// Parameters in the order in which they stand in the line; a letter stands once for each axis in a {...}.
class Arguments {
 public:
  Arguments& add(std::string_view letter, std::string value);
  Arguments& axes(AxisSet axes);                                                       // a
  Arguments& pulses(std::int64_t signed_pulses);                                       // m u y, in pulses
  Arguments& speeds(std::int64_t minimum, std::int64_t maximum, int acceleration_ms);  // spds spdf r

  const std::vector<std::pair<std::string, std::string>>& values() const { return values_; }
  std::optional<std::string> first(std::string_view letter) const;
  friend bool operator==(const Arguments&, const Arguments&) = default;

 private:
  std::vector<std::pair<std::string, std::string>> values_;
};

// The line without terminator, in the one strict form that the gateway sends. Refuses values out of their range
// (out_of_range) and arguments that do not fit the format (invalid_request).
Result<std::string> encode(const CommandRow& row, const Arguments& arguments);

// The other way; takes what clients write: either case, no sign (+), no unit (P), blanks after commas. Nothing where
// the text is not of this row's shape; a Problem where the shape fits and a value is out of range.
std::optional<Result<Arguments>> decode(const CommandRow& row, std::string_view text);

}  // namespace axisgate::shrc203
