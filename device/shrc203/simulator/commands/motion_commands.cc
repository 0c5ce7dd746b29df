#include <algorithm>
#include <array>

#include "device/shrc203/simulator/commands/setters.h"

namespace axisgate::shrc203::simulator {
namespace {

// H: HRT: Z: ZRT: (manual 59) to 62)). The origin methods 0 to 4 differ in sensors that a simulated stage does not
// have.
Answer go_back(Rig& rig, Reader reader, Kind kind, bool reports) {
  const auto axes = reader.take_axes_or_all(rig.controllable);
  if (!axes || !reader.done() || !rig.is_free(*axes) || !rig.can_move(*axes)) return Answer::ng;
  rig.motions.start_return(kind, *axes, reports, rig.now);
  return Answer::ok;
}

Answer origin_return(Rig& rig, Reader reader) { return go_back(rig, reader, Kind::origin_return, false); }
Answer origin_return_reported(Rig& rig, Reader reader) { return go_back(rig, reader, Kind::origin_return, true); }
Answer logical_return(Rig& rig, Reader reader) { return go_back(rig, reader, Kind::logical_return, false); }
Answer logical_return_reported(Rig& rig, Reader reader) { return go_back(rig, reader, Kind::logical_return, true); }

Answer set_origin(Rig& rig, Reader reader, void (Axis::*set)()) {
  const auto axes = reader.take_axes_or_all(rig.controllable);
  if (!axes || !reader.done() || !rig.is_free(*axes) || !rig.is_excited(*axes)) return Answer::ng;
  for (const int axis : axes->list()) (rig.axis(axis).*set)();
  return Answer::ok;
}

Answer zero(Rig& rig, Reader reader) { return set_origin(rig, reader, &Axis::set_logical_origin); }
Answer unzero(Rig& rig, Reader reader) { return set_origin(rig, reader, &Axis::clear_logical_origin); }

// L: and L:E (manual 65), 66)).
Answer stop(Rig& rig, Reader reader) {
  if (reader.rest() == "E") {
    rig.motions.emergency_stop(rig.now);
    return Answer::ok;
  }
  const auto axes = reader.take_axes_or_all(rig.controllable);
  if (!axes || !reader.done()) return Answer::ng;
  Axes stopping;
  for (const int axis : axes->list()) {
    if (rig.axis(axis).excited) stopping.add(axis);
  }
  const bool partly = rig.options.is("stop_with_unexcited_axis", "stops_excited");
  if (stopping.empty() || (stopping != *axes && !partly)) return Answer::ng;
  rig.motions.stop(stopping, rig.now);
  return Answer::ok;
}

Answer go(Rig& rig, Reader reader) {
  const auto axes = reader.take_axes_or_all(rig.controllable);
  if (!axes || !reader.done() || !rig.is_free(*axes) || !rig.can_move(*axes)) return Answer::ng;
  return answer_if(rig.motions.go(*axes, rig.now));
}

Answer delete_settings(Rig& rig, Reader reader) {
  const auto axes = reader.take_axes_or_all(rig.controllable);
  if (!axes || !reader.done() || !rig.is_free(*axes) || !rig.is_excited(*axes)) return Answer::ng;
  rig.motions.delete_execution(*axes);
  return Answer::ok;
}

constexpr std::array kMotionCommands = {
    Command{"H:", origin_return},
    Command{"H0:", origin_return},
    Command{"H1:", origin_return},
    Command{"H2:", origin_return},
    Command{"H3:", origin_return},
    Command{"H4:", origin_return},
    Command{"HRT:", origin_return_reported},
    Command{"HRT0:", origin_return_reported},
    Command{"HRT1:", origin_return_reported},
    Command{"HRT2:", origin_return_reported},
    Command{"HRT3:", origin_return_reported},
    Command{"HRT4:", origin_return_reported},
    Command{"Z:", logical_return},
    Command{"ZRT:", logical_return_reported},
    Command{"R:", zero},
    Command{"RC:", unzero},
    Command{"L:", stop},
    Command{"G", go},
    Command{"G:", go},
    Command{"GC:", delete_settings},
};

}  // namespace

const Command* find_motion_command(std::string_view verb) {
  const auto found = std::find_if(kMotionCommands.begin(), kMotionCommands.end(),
                                  [&](const Command& command) { return command.verb == verb; });
  return found == kMotionCommands.end() ? nullptr : &*found;
}

}  // namespace axisgate::shrc203::simulator
