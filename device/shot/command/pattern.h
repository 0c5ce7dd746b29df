// The format language of command_row.h: builds a line from its parameters, and splits a line into them.
//
//   text    literal text                  <a>     parameter of the row, by its letter in the manual
//   [...]   optional part                 {...|s} repeated for each axis of <a>, separated by `s`
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/problem.h"
#include "device/shot/command/axes.h"
#include "device/shot/command/command_row.h"

namespace axisgate::shot {

// Parameters in the order of the line; inside {...} a letter occurs once for each axis.
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

// Returns the line without terminator, in the only form that the gateway sends. Fails with out_of_range for a value
// outside its range; with invalid_request for arguments that do not fit the format.
Result<std::string> encode(const CommandRow& row, const Arguments& arguments);

// Parses a line, in the forms that clients write: either case, no sign (+), no unit (P), blanks after commas. nullopt
// if the text does not have this row's form; a Problem if the form fits and a value is out of range.
std::optional<Result<Arguments>> decode(const CommandRow& row, std::string_view text);

}  // namespace axisgate::shot
