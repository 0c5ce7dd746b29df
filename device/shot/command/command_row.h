// A row of a model's table of commands. Encoding, validation, reply parsing, scheduling, the generic Execute, the
// command line's help and the tests read the rows; no other part of the gateway knows how a command is written.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "device/core/lane.h"
#include "device/core/time.h"

namespace axisgate::shot {

// A parameter: one letter of the manual's command format.
struct Parameter {
  enum class Kind {
    choice,   // one of the words of `choices`, separated by blanks
    integer,  // minimum to maximum
    decimal,  // digits with an optional point; minimum and maximum apply only to whole pulses, as the unit before it
              // says
    angle,    // degrees, digits with an optional point; above 0, up to maximum
    text,     // the rest of the line
  };
  std::string_view letter;   // as printed in the manual: a, m, u, y, spds ...
  std::string_view meaning;  // for people
  Kind kind = Kind::choice;
  std::string_view choices = {};
  std::int64_t minimum = 0;
  std::int64_t maximum = 0;
  std::string_view unit = {};
};

// Method that distinguishes this row's answer from a completion, which is the bare number of an axis.
enum class Separation {
  grammar,   // the answer is never a bare axis number
  all_axes,  // the question is sent for all axes, so that the answer contains commas, and the wanted fields are picked
  waits,     // not sent while a completion within the answer's range may come
  closed,    // while one motion runs: closed by an !:S, and repeated until two answers agree; otherwise as `waits`
};

// Modes in which commands work, as ?:MODE names them (manual 37)). In the modes of P:R and MS:ON no other caller is
// answered.
enum class Mode { host, program, program_edit, memory_switches };

// Conditions that the manual requires for the command to be accepted.
struct Needs {
  bool ready = false;     // "In the case of Busy ... NG"
  bool excited = false;   // "... or the motor excitation is OFF"
  bool no_limit = false;  // "... or the limit sensor is detected"
  bool any_mode = false;  // also accepted outside HOST (manual 4., last note)
  Mode mode = Mode::host;
};

// Setting written by the command that a G may start (manual 85)).
enum class Register { none, m, a, k, e, j, mp, ap, kp, ep, wt, wi };

// Speeds that a command may change permanently: those of D: (manual 89)), also changed by a prebuffer setting with its
// own speeds (68)), or those of the mechanical origin return (94) B:).
enum class SetsSpeeds { no, of_motion, of_origin_return };

// The curves of E: and EP: (manual 71) to 82)), in the order of their digits in the manual.
enum class CurveForm { circle, arc_by_angle, arc_through, helix_of_turns, helix_by_angle, helix_through };

// Role of a row for code that decides by it, beyond the row's other attributes.
enum class Meaning {
  none,
  inquiry,            // question of ?: or *IDN?, also answered outside HOST
  line_before,        // as inquiry; reports the line received before it
  go,                 // starts the motion that was set
  jog,                // for axes that run until they are stopped
  clear_setpoints,    // deletes settings that were not started
  mechanical_return,  // mechanical origin return; the axis learns its coordinates
  logical_return,     // return to coordinate 0
  sleep,              // sleeps or wakes up
  emergency_stop,
  minimum_speed,   // sets S and leaves F unchanged
  maximum_speed,   // sets F and leaves S unchanged
  outputs,         // sets the general-purpose outputs
  mode_or_format,  // following lines may no longer be understood
  program_pause,   // pauses or continues a program
  program_step,    // writes a line of a program
  switches,        // sets memory switches of one item
  to_place,        // moves to a saved position: PIT:
  to_coordinates,  // moves to saved coordinates: PAV:
  saved_position,  // asks for the coordinates of a saved position
};

enum class Effect {
  question,        // changes nothing
  setting,         // changes a setting without motion
  motion_setting,  // writes a Register, which a G starts
  motion,          // starts a motion when accepted
  stop,
};

enum class CommandScope { controller, axes };

struct CommandRow {
  std::string_view name;    // "MP:", as in the documents of this folder
  std::string_view format;  // see pattern.h; letters in <> are in `parameters`
  std::string_view description;
  int section;  // section number in the manual
  std::span<const Parameter> parameters;
  std::string_view reply;  // see reply.h
  Effect effect = Effect::question;
  Lane lane = Lane::question;
  CommandScope scope = CommandScope::controller;
  Separation separation = Separation::grammar;
  Needs needs = {};
  Register reg = Register::none;
  bool shifts_frame = false;   // changes the coordinate of the present position
  bool third_axis = false;     // also moves axis 3, besides the named axes
  bool beside_motion = false;  // does not affect motion, so it waits for none
  bool rescales = false;       // changes the resolution
  bool restarts = false;       // restarts the controller, which is silent meanwhile
  SetsSpeeds sets_speeds = SetsSpeeds::no;
  bool completes = false;           // completions follow its end; for G and G: only after a prebuffer setting
  std::optional<Mode> enters = {};  // mode after the command; nullopt if unchanged
  std::optional<CurveForm> curve = {};
  Meaning meaning = Meaning::none;
  Duration reply_limit = {};  // zero: the profile's limit

  // Reports whether the row is answered in every mode except program edit mode.
  constexpr bool answered_off_host() const { return meaning == Meaning::inquiry || meaning == Meaning::line_before; }
  constexpr bool moves() const { return effect == Effect::motion; }
  // Reports whether the row is a prebuffer setting, whose OK_D means that it chains (manual section 2).
  constexpr bool may_chain() const { return reply == "OK|OK_D"; }
  // Reports whether the reply has position, status and READY of each axis.
  constexpr bool reads_each_axis() const { return reply == "amount*,hex*,ready*"; }
};

}  // namespace axisgate::shot
