#include "device/shrc203/command/saved_positions.h"

#include <fmt/format.h>

#include "device/shot/command/reply.h"
#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203 {

PositionLines position_lines(const PositionSlot& slot) {
  const auto line = [&](std::string_view verb) {
    return fmt::format("{}{},{}", slot.place ? "PIT:" : "PAV:", verb, slot.number);
  };
  return {line("SET"), line("GET"), line("DEL")};
}

std::map<int, std::int64_t> read_position(const PositionSlot& slot, std::string_view answer, AxisSet controllable) {
  const CommandRow& row = model().row(slot.place ? "PIT:GET" : "PAV:GET");
  const auto reply = parse_reply(model(), row, answer, controllable.count());
  std::map<int, std::int64_t> coordinates;
  if (!reply || reply->kind != Reply::Kind::data) return coordinates;
  for (const auto& [axis, pulses] : by_axis(model(), *reply, controllable)) coordinates[axis] = *parse_integer(pulses);
  return coordinates;
}

}  // namespace axisgate::shrc203
