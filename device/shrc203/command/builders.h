// The commands that the gateway itself sends, in the field's words: nothing outside this folder spells their names. A
// value that does not fit is a defect, and aborts, where nothing else is said. The numbers are the manual's.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "device/shrc203/command/codec.h"
#include "device/shrc203/stage.h"

namespace axisgate::shrc203::commands {

using Amounts = std::map<int, std::int64_t>;  // in pulses, or pulses/s, by axis
using Speeds = std::map<int, SpeedSetting>;   // by axis

// What is asked with always the same line.
enum class Question {
  identity,
  ready,
  each_ready,
  positions,       // by the command counter, in pulses
  scale_counters,  // likewise, by the scale
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
std::string_view text(Question question);  // the line
const CommandRow& row_of(Question question);
// The question that reports what the register holds; for none, setpoint_a.
Question question_of(Register reg);

// The one setter of a register; E: and EP: have one for each CurveForm.
const CommandRow& setter_of(Register reg);
// 67) M:, 68) MP:, 69) A:, 70) AP:, 83) K:, 84) KP:. A prebuffer takes speeds as well: a line's one, or all axes'.
Command set_setpoint(Register reg, const Amounts& amounts, const Speeds& speeds = {});
// 77) to 82) EP:. out_of_range.
Result<Command> set_curve(CurveForm form, const Arguments& arguments);
Command set_jog(const Amounts& directions);     // 88) J:, by the sign
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
bool can_be_set(const SpeedSetting& speed);       // by D: or B:
Command set_outputs(int pattern);                 // 96) O:
Command clear_errors(AxisSet axes);               // 53) BEC:

Command stop_program();              // 107) P:E
Command leave_program_mode();        // 103) P:H
Command leave_program_edit();        // 112) P:OFF
Command leave_switches();            // 118) MS:OFF
Command ask_all_switches(int item);  // 124) MS:GETK

}  // namespace axisgate::shrc203::commands
