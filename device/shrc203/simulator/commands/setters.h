// The commands that change something (manual 45) to 96)).
#pragma once

#include <string_view>

#include "device/shrc203/simulator/commands/reader.h"
#include "device/shrc203/simulator/rig.h"

namespace axisgate::shrc203::simulator {

enum class Answer { ng, ok, ok_d };

// Carries out a command. `line` is in upper case and has no blanks. RESET: is only answered here; the machine carries
// it out.
Answer execute(Rig& rig, std::string_view line);

// One command: its verb up to and including the colon. `arguments` follows the verb.
struct Command {
  std::string_view verb;
  Answer (*run)(Rig& rig, Reader arguments);
};

const Command* find_controller_command(std::string_view verb);  // settings of the controller and of its axes
const Command* find_motion_command(std::string_view verb);      // starts, stops and returns
const Command* find_buffer_command(std::string_view verb);      // the two buffers
const Command* find_trigger_command(std::string_view verb);
const Command* find_saved_position_command(std::string_view verb);
const Command* find_memory_switch_command(std::string_view verb);
const Command* find_program_command(std::string_view verb);  // all P: commands except P:GET

inline Answer answer_if(bool accepted) { return accepted ? Answer::ok : Answer::ng; }

bool is_division(std::int64_t division);  // manual 55) S:

// Reads S, F and R one after another, in `unit` per second; nullopt unless each is in range and S <= F (manual 68),
// 89)).
std::optional<Speed> take_speed(const Rig& rig, Reader& reader, char unit, int axis);

}  // namespace axisgate::shrc203::simulator
