#include "device/rml1/language/instruction_table.h"

namespace axisgate::rml1 {
namespace {

constexpr Parameter kCoordinate{};
// W, !DW: "0 to 32,767 msec"; other values are error 3.
constexpr Parameter kMilliseconds{true, 0, kIntHighest, true, true};
// F, VS: "No error is generated"; "float for noninteger values".
constexpr Parameter kPlaneSpeed{false, kIntLowest, kIntHighest, false, false};
// V, !VZ: "An out-of-range parameter results in error 3".
constexpr Parameter kHeightSpeed{false, kIntLowest, kIntHighest, true, true};
// @, !PZ: "Error3 results if Z1 is higher than zero or if Z2 is less than zero". Machine checks its Z range.
constexpr Parameter kZ1{true, kLongLowest, 0, true, true};
constexpr Parameter kZ2{true, 0, kLongHighest, true, false};
constexpr Parameter kSwitch{true, kIntLowest, kIntHighest, false, false};
// !RC: "A negative parameter results in error 3. Parameters exceeding 8388607 also".
constexpr Parameter kRevolutions{true, 0, kLongHighest, true, true};
// !ZM, !ZO: "when a float value is input the decimal-fraction portion is ignored". Machine checks its Z range.
constexpr Parameter kMachineHeight{true, kLongLowest, kLongHighest, true, true};

constexpr Row plot(std::string_view name, Coordinates coordinates, Tool tool) {
  return {name, Operation::plot,           name.size() == 1 ? "3-1" : "3-2", Takes::sets, 2, coordinates,
          tool, {kCoordinate, kCoordinate}};
}

constexpr Row nothing(std::string_view name, Operation operation, std::string_view section,
                      Coordinates coordinates = Coordinates::kept, Tool tool = Tool::kept) {
  return {name, operation, section, Takes::nothing, 0, coordinates, tool, {}};
}

constexpr Row one(std::string_view name, Operation operation, std::string_view section, Parameter parameter) {
  return {name, operation, section, Takes::up_to, 1, Coordinates::kept, Tool::kept, {parameter}};
}

constexpr Row heights(std::string_view name, std::string_view section) {
  return {name, Operation::heights, section, Takes::up_to, 2, Coordinates::kept, Tool::kept, {kZ1, kZ2}};
}

constexpr Row feed(std::string_view name, std::string_view section) {
  return {name, Operation::feed,   section,    Takes::sets,
          3,    Coordinates::kept, Tool::kept, {kCoordinate, kCoordinate, kCoordinate}};
}

constexpr Row kRows[] = {
    heights("@", "3-1"),
    plot("D", Coordinates::absolute, Tool::lowered),
    plot("I", Coordinates::relative, Tool::lowered),
    plot("M", Coordinates::absolute, Tool::raised),
    plot("R", Coordinates::relative, Tool::raised),
    nothing("^", Operation::call, "3-1"),
    nothing("H", Operation::home, "3-1", Coordinates::absolute, Tool::raised),
    one("F", Operation::plane_speed, "3-1", kPlaneSpeed),
    one("V", Operation::height_speed, "3-1", kHeightSpeed),
    one("W", Operation::dwell, "3-1", kMilliseconds),
    feed("Z", "3-1"),
    nothing("DF", Operation::defaults, "3-2", Coordinates::absolute),
    nothing("IN", Operation::initialize, "3-2", Coordinates::absolute, Tool::raised),
    plot("PA", Coordinates::absolute, Tool::kept),
    plot("PD", Coordinates::kept, Tool::lowered),
    plot("PR", Coordinates::relative, Tool::kept),
    plot("PU", Coordinates::kept, Tool::raised),
    one("VS", Operation::plane_speed, "3-2", kPlaneSpeed),
    one("!DW", Operation::dwell, "3-3", kMilliseconds),
    one("!MC", Operation::spindle, "3-3", kSwitch),
    nothing("!NR", Operation::pause, "3-3"),
    heights("!PZ", "3-3"),
    one("!RC", Operation::revolutions, "3-3", kRevolutions),
    one("!VZ", Operation::height_speed, "3-3", kHeightSpeed),
    one("!ZM", Operation::height, "3-3", kMachineHeight),
    one("!ZO", Operation::surface, "3-3", kMachineHeight),
    {"!ZE", Operation::extension, "3-3", Takes::axes, 0, Coordinates::kept, Tool::kept, {}},
    feed("!ZZ", "3-3"),
};

constexpr Row beyond(Row row) {
  row.beyond_guideline = true;
  return row;
}

constexpr Row kTolerated[] = {
    beyond(one("J", Operation::ignored, "2-2", kSwitch)),
    beyond(one("!", Operation::spindle, "2-2", kSwitch)),
};

}  // namespace

std::span<const Row> guideline_rows() { return kRows; }

const Row& tolerated_row(std::string_view name) { return name == "J" ? kTolerated[0] : kTolerated[1]; }

InstructionTable::InstructionTable(std::span<const Row> rows, std::span<const Row> more)
    : rows_(rows.begin(), rows.end()) {
  rows_.insert(rows_.end(), more.begin(), more.end());
  std::uint8_t number = 0;
  for (const Row& row : rows_) {
    ++number;
    const auto first = static_cast<unsigned char>(row.name[0]);
    if (row.name.size() == 1) {
      letters_[first] = number;
      if (is_letter(row.name[0])) letters_[first | 0x20u] = number;
    } else if (row.name.size() == 2) {
      pairs_[index(row.name[0], row.name[1])] = number;
      begins_pair_[letter_index(row.name[0])] = true;
    } else {
      common_[index(row.name[1], row.name[2])] = number;
    }
  }
}

}  // namespace axisgate::rml1
