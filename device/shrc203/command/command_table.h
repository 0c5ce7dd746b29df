// The one table of the controller's commands. Encoding, validation, reply parsing, scheduling, the generic Execute, the
// command line's help and the tests read these rows; nothing else in the gateway knows how a command is written.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "device/core/lane.h"
#include "device/core/time.h"

namespace axisgate::shrc203 {

// One letter of the manual's command format.
struct Parameter {
  enum class Kind {
    choice,   // one of the words of `choices`, separated by blanks
    integer,  // minimum to maximum
    decimal,  // digits with an optional point; minimum to maximum apply to whole pulses only, by the unit before it
    angle,    // degrees, digits with an optional point; more than 0, up to maximum
    text,     // the rest of the line
  };
  std::string_view letter;   // as the manual writes it: a, m, u, y, spds ...
  std::string_view meaning;  // for people
  Kind kind = Kind::choice;
  std::string_view choices = {};
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  std::string_view unit = {};
};

// How this row's answer is kept apart from a completion, which is a bare 1, 2 or 3.
enum class Separation {
  grammar,   // the answer is never a bare axis number
  all_axes,  // sent for all axes and the wanted fields picked, so that the answer has commas
  waits,     // not sent while a possible completion lies within the answer's range
  closed,    // while a single motion runs: closed by an !:S and asked until two answers agree; else as `waits`
};

// Where a command works, and how ?:MODE names it (manual 37)). Out of HOST by P:R and MS:ON nobody else is answered.
enum class Mode { host, program, program_edit, memory_switches };

// What the manual demands for the command to be accepted.
struct Needs {
  bool ready = false;     // "In the case of Busy ... NG"
  bool excited = false;   // "... or the motor excitation is OFF"
  bool no_limit = false;  // "... or the limit sensor is detected"
  bool any_mode = false;  // usable off HOST too (manual 4., last note)
  Mode mode = Mode::host;
};

// Which of the settings that a G may start (manual 85)) the command writes.
enum class Register { none, m, a, k, e, j, mp, ap, kp, ep, wt, wi };

// Which speeds a command may set for good: those of D: (manual 89)), also by a prebuffer setting that has some of its
// own (68)), or those of the mechanical origin return (94) B:).
enum class SetsSpeeds { no, of_motion, of_origin_return };

// The curves of E: and EP: (manual 71) to 82)), in the order of the digits that name them there.
enum class CurveForm { circle, arc_by_angle, arc_through, helix_of_turns, helix_by_angle, helix_through };

// What a row is to who decides something by it, beyond its other attributes.
enum class Meaning {
  none,
  inquiry,            // a question of ?: or *IDN?, which is answered out of HOST too
  line_before,        // likewise, and it reports the line before it
  go,                 // starts what was set
  jog,                // for axes that run until somebody stops them
  clear_setpoints,    // deletes what was set and not started
  mechanical_return,  // an axis comes to know its places by it
  logical_return,     // to coordinate 0
  sleep,              // or wakes up
  emergency_stop,
  minimum_speed,   // sets S and leaves F alone
  maximum_speed,   // sets F and leaves S alone
  outputs,         // sets the general-purpose outputs
  mode_or_format,  // what follows may not be understood any more
  program_pause,   // and its going on
  program_step,    // writes a line of a program
  switches,        // sets memory switches of an item
  to_place,        // moves to a saved position: PIT:
  to_coordinates,  // likewise: PAV:
  saved_position,  // the question where such a motion would lead
};

enum class Effect {
  question,        // changes nothing
  setting,         // changes a setting; nothing moves
  motion_setting,  // writes a Register that a G starts
  motion,          // sets the stage moving when accepted
  stop,
};

enum class CommandScope { controller, axes };

struct CommandRow {
  std::string_view name;    // "MP:", as the documents of this folder name it
  std::string_view format;  // see pattern.h; letters in <> are `parameters`
  std::string_view description;
  int section;  // of the manual
  std::span<const Parameter> parameters;
  std::string_view reply;  // see reply.h
  Effect effect = Effect::question;
  Lane lane = Lane::question;
  CommandScope scope = CommandScope::controller;
  Separation separation = Separation::grammar;
  Needs needs = {};
  Register reg = Register::none;
  bool shifts_frame = false;   // makes another coordinate of the place where the axis stands
  bool third_axis = false;     // moves axis 3 beside the axes that it names
  bool beside_motion = false;  // nothing to motion, so that it waits for none
  bool rescales = false;       // the resolution is another afterwards
  bool restarts = false;       // the controller boots, and is silent meanwhile
  SetsSpeeds sets_speeds = SetsSpeeds::no;
  bool completes = false;  // axis numbers follow once it has ended; for G and G: after a prebuffer setting only
  std::optional<Mode> enters = {};  // the mode that follows, where it is another
  std::optional<CurveForm> curve = {};
  Meaning meaning = Meaning::none;
  Duration reply_limit = {};  // zero: the profile's

  // Wherever the controller is but in program edit mode.
  constexpr bool answered_off_host() const { return meaning == Meaning::inquiry || meaning == Meaning::line_before; }
  constexpr bool moves() const { return effect == Effect::motion; }
  // A prebuffer setting: OK_D says that it chains (manual section 2).
  constexpr bool may_chain() const { return reply == "OK|OK_D"; }
};

std::span<const CommandRow> command_table();

// The row of that name, which must exist. For this folder and tests: other code of the driver has
// commands from builders.h, and decides by the attributes of their rows.
const CommandRow& command_row(std::string_view name);

}  // namespace axisgate::shrc203
