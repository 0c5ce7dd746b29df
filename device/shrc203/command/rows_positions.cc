// Rows of the command table for saved positions: places (PIT:), which stay the same place when coordinates are set
// again, and coordinates (PAV:) (manual 127) to 136)).
#include "device/shrc203/command/rows.h"

namespace axisgate::shrc203::rows {
namespace {

constexpr Parameter kNumber{"n", "number of the saved position", Kind::integer, {}, 1, 20};
constexpr std::array kNumberOnly{kNumber};

constexpr CommandRow of_position(std::string_view name, std::string_view format, std::string_view description,
                                 int section) {
  return whole_controller(command(name, format, description, section, kNumberOnly, Effect::setting, kReady));
}

constexpr CommandRow coordinates(std::string_view name, std::string_view format, std::string_view description,
                                 int section) {
  CommandRow row = question(name, format, description, section, kNumberOnly, "number:-999999999:999999999*");
  row.separation = Separation::waits;  // the answer of one axis is a bare number
  return row;
}

constexpr CommandRow goes_there(std::string_view name, std::string_view format, std::string_view description,
                                int section) {
  return whole_controller(command(name, format, description, section, kNumberOnly, Effect::motion, kReadyExcited));
}

constexpr CommandRow kPositionsRows[] = {
    of_position("PIT:DEL", "PIT:DEL,<n>", "delete a saved position", 127),
    of_position("PIT:SET", "PIT:SET,<n>", "save the present position", 128),
    means(Meaning::saved_position,
          coordinates("PIT:GET", "PIT:GET,<n>", "present coordinates of a saved position", 129)),
    means(Meaning::to_place, goes_there("PIT:G", "PIT:G,<n>", "go to a saved position", 130)),
    means(Meaning::to_place,
          completes(goes_there("PIT:GRT", "PIT:GRT,<n>", "go to a saved position, with completions", 131))),
    of_position("PAV:DEL", "PAV:DEL,<n>", "forget saved coordinates", 132),
    of_position("PAV:SET", "PAV:SET,<n>", "save the present coordinates", 133),
    means(Meaning::saved_position, coordinates("PAV:GET", "PAV:GET,<n>", "saved coordinates", 134)),
    means(Meaning::to_coordinates, goes_there("PAV:G", "PAV:G,<n>", "go to saved coordinates", 135)),
    means(Meaning::to_coordinates,
          completes(goes_there("PAV:GRT", "PAV:GRT,<n>", "go to saved coordinates, with completions", 136))),
};

}  // namespace

std::span<const CommandRow> saved_positions() { return kPositionsRows; }

}  // namespace axisgate::shrc203::rows
