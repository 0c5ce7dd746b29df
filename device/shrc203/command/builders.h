// The commands that the gateway itself sends, named in the field's terms: only this folder knows their letters. Unless
// stated otherwise, a value that does not fit is a defect and aborts. The numbers are the manual's.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "device/shot/command/command.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203::commands {

using Amounts = std::map<int, std::int64_t>;  // in pulses, or pulses/s, by axis
using Speeds = std::map<int, SpeedSetting>;   // by axis

// Questions that are always the same line.
enum class Question {
  identity,
  ready,
  each_ready,
  positions,       // command counters, in pulses
  scale_counters,  // scale counters, in pulses
  scale_resolution,
  pulse_length,
  speeds,
  origin_speeds,
  setpoint_m,
  setpoint_mp,
  setpoint_a,
  setpoint_ap,
  setpoint_e,
  setpoint_ep,
  setpoint_k,
  setpoint_kp,
  setpoint_j,
  wait_set,
  input_wait_set,
  outputs,
  inputs,
  auto_config,
  excitation,
  sleep,
  mode,
  format,
  previous_command,
  program,
  trigger,
  serial_number,
  axes,
};

Command ask(Question question);
std::string_view text(Question question);  // line of the question
const CommandRow& row_of(Question question);
// Returns the question that reports the register's content; setpoint_a for Register::none.
Question question_of(Register reg);

// Returns the only setter of a register; E: and EP: have one for each CurveForm instead.
const CommandRow& setter_of(Register reg);
// 67) M:, 68) MP:, 69) A:, 70) AP:, 83) K:, 84) KP:. Prebuffer settings may include speeds: one set for a line, or one
// for each axis.
Command set_setpoint(Register reg, const Amounts& amounts, const Speeds& speeds = {});
// 77) to 82) EP:. Fails with out_of_range.
Result<Command> set_curve(CurveForm form, const Arguments& arguments);
Command set_jog(const Amounts& directions);     // 88) J:, direction by sign
Command set_jog_speeds(const Amounts& speeds);  // 93) JD:
Command clear_setpoints(AxisSet axes);          // 87) GC:

Command go(AxisSet axes);                // 86) G:
Command home(AxisSet axes);              // 60) HRT:
Command return_to_origin(AxisSet axes);  // 62) ZRT:
Command stop(AxisSet axes);              // 65) L:
Command emergency_stop();                // 66) L:E

// The two kinds of saved positions: PIT: and PAV:.
enum class Saved { place, coordinates };
Command ask_saved(Saved kind, std::string number);    // 129) PIT:GET, 134) PAV:GET
Command go_to_saved(Saved kind, std::string number);  // 131) PIT:GRT, 136) PAV:GRT

Command set_speeds(const Speeds& speeds);         // 89) D:
Command set_origin_speeds(const Speeds& speeds);  // 94) B:
bool can_be_set(const SpeedSetting& speed);       // fits D: and B:
Command set_outputs(int pattern);                 // 96) O:
Command clear_errors(AxisSet axes);               // 53) BEC:

Command stop_program();              // 107) P:E
Command leave_program_mode();        // 103) P:H
Command leave_program_edit();        // 112) P:OFF
Command leave_switches();            // 118) MS:OFF
Command ask_all_switches(int item);  // 124) MS:GETK

}  // namespace axisgate::shrc203::commands
