#include "device/shrc203/simulator/saved_positions.h"

#include <algorithm>

#include "device/shrc203/simulator/commands/questions.h"
#include "device/shrc203/simulator/commands/setters.h"

namespace axisgate::shrc203::simulator {
namespace {

using Table = SavedPositions::Table;

std::optional<std::size_t> take_index(Reader& reader) {
  const auto number = reader.take(',') ? reader.take_integer(1, SavedPositions::kCount) : std::nullopt;
  return number && reader.done() ? std::optional(static_cast<std::size_t>(*number - 1)) : std::nullopt;
}

SavedPosition here(const Rig& rig, bool place) {
  SavedPosition position;
  for (const int number : kAxisNumbers) {
    const Axis& axis = rig.axis(number);
    position.pulses[index_of(number)] = axis.coordinate(rig.now) + (place ? axis.zero() : 0);
    position.divide[index_of(number)] = axis.divide();
  }
  return position;
}

// Manual 129): a place is reported as the coordinate that the counter would show there now. S: does not move the place.
std::int64_t coordinate_of(const Rig& rig, const SavedPosition& position, bool place, int number) {
  const std::int64_t pulses = position.pulses[index_of(number)];
  if (!place) return pulses;
  const Axis& axis = rig.axis(number);
  return pulses * axis.divide() / position.divide[index_of(number)] - axis.zero();
}

Answer move_to(Rig& rig, const SavedPosition& position, bool place, bool reports) {
  if (!rig.can_move(rig.controllable)) return Answer::ng;
  Setting setting;
  setting.kind = Kind::saved_position;
  setting.axes = rig.controllable;
  for (const int axis : setting.axes.list()) {
    setting.values[index_of(axis)] = coordinate_of(rig, position, place, axis);
  }
  rig.motions.start_each(setting, reports, rig.now);
  return Answer::ok;
}

Answer use(Rig& rig, Reader reader, bool place) {
  Table& table = place ? rig.saved.places : rig.saved.coordinates;
  if (rig.motions.busy(rig.controllable)) return Answer::ng;
  // GRT comes before G, since it begins with G.
  for (const std::string_view verb : {"DEL", "SET", "GRT", "G"}) {
    if (!reader.take_text(verb)) continue;
    const auto index = take_index(reader);
    if (!index) return Answer::ng;
    auto& position = table[*index];
    if (verb == "DEL") {
      position.reset();
      return Answer::ok;
    }
    if (verb == "SET") {
      position = here(rig, place);
      return Answer::ok;
    }
    return position ? move_to(rig, *position, place, verb == "GRT") : Answer::ng;
  }
  return Answer::ng;
}

Answer use_place(Rig& rig, Reader reader) { return use(rig, reader, true); }
Answer use_coordinates(Rig& rig, Reader reader) { return use(rig, reader, false); }

constexpr std::array kPositionCommands = {Command{"PIT:", use_place}, Command{"PAV:", use_coordinates}};

}  // namespace

std::optional<std::string> answer_saved_position(const Rig& rig, std::string_view line) {
  Reader reader(line);
  const bool place = reader.take_text("PIT:GET");
  if (!place && !reader.take_text("PAV:GET")) return std::nullopt;
  const auto index = take_index(reader);
  if (!index) return std::nullopt;
  const auto& position = (place ? rig.saved.places : rig.saved.coordinates)[*index];
  if (!position) return std::nullopt;
  return join_fields(rig.controllable,
                     [&](int axis) { return std::to_string(coordinate_of(rig, *position, place, axis)); });
}

const Command* find_saved_position_command(std::string_view verb) {
  const auto found = std::find_if(kPositionCommands.begin(), kPositionCommands.end(),
                                  [&](const Command& command) { return command.verb == verb; });
  return found == kPositionCommands.end() ? nullptr : &*found;
}

}  // namespace axisgate::shrc203::simulator
