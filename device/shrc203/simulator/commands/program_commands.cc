#include "device/shrc203/simulator/commands/program_commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "device/shrc203/simulator/commands/setters.h"
#include "device/shrc203/simulator/program_run.h"

namespace axisgate::shrc203::simulator {
namespace {

using Status = ProgramRun::Status;

// A running or paused program counts as BUSY.
bool all_rest(const Rig& rig) { return !rig.program.run.active() && !rig.motions.busy(rig.controllable); }

// --- program mode ----------------------------------------------------------------------------------------------------

Answer enter(Rig& rig, Reader reader) {
  if (!reader.done() || !all_rest(rig)) return Answer::ng;
  rig.mode = "HOST,PROGRAM";
  rig.program.editing = false;
  return Answer::ok;
}

Answer leave(Rig& rig, Reader reader) {
  if (!reader.done() || !all_rest(rig)) return Answer::ng;
  rig.mode = "HOST";
  return Answer::ok;
}

Answer choose(Rig& rig, Reader reader) {
  const auto number = reader.take_integer(1, ProgramMode::kPrograms);
  if (!number || !reader.done() || !all_rest(rig)) return Answer::ng;
  rig.program.number = static_cast<int>(*number);
  rig.program.run = {};
  return Answer::ok;
}

Answer start(Rig& rig, Reader reader) {
  if (!reader.done() || !all_rest(rig)) return Answer::ng;
  start_program(rig, false);
  return Answer::ok;
}

Answer start_one_line(Rig& rig, Reader reader) {
  if (!reader.done() || rig.motions.busy(rig.controllable)) return Answer::ng;
  if (rig.program.run.status == Status::paused) {
    resume_program(rig, true);
    return Answer::ok;
  }
  if (rig.program.run.active()) return Answer::ng;
  start_program(rig, true);
  return Answer::ok;
}

Answer stop_program(Rig& rig, Reader reader) {
  if (!reader.done()) return Answer::ng;
  if (rig.program.run.active()) stop_program(rig);
  return Answer::ok;
}

// Manual 108): 0 pauses, 1 continues.
Answer pause(Rig& rig, Reader reader) {
  const auto value = reader.take_digit(1);
  const bool paused = rig.program.run.status == Status::paused;
  if (!value || !reader.done() || !rig.program.run.active() || paused != (*value == 1)) return Answer::ng;
  if (paused) {
    resume_program(rig, false);
  } else {
    pause_program(rig);
  }
  return Answer::ok;
}

Answer switch_notice(Rig& rig, Reader reader, bool ProgramMode::*flag) {
  const auto value = reader.take_digit(1);
  if (!value || !reader.done() || !all_rest(rig)) return Answer::ng;
  rig.program.*flag = *value == 1;
  return Answer::ok;
}

Answer tell_completion(Rig& rig, Reader reader) { return switch_notice(rig, reader, &ProgramMode::reports_completion); }
Answer tell_trigger(Rig& rig, Reader reader) { return switch_notice(rig, reader, &ProgramMode::reports_trigger); }

Answer edit(Rig& rig, Reader reader) {
  if (!reader.done() || !all_rest(rig)) return Answer::ng;
  rig.program.edited = rig.program.chosen();
  rig.program.editing = true;
  return Answer::ok;
}

// --- program edit mode -----------------------------------------------------------------------------------------------

Answer save(Rig& rig, Reader reader) {
  if (!reader.done() || !all_rest(rig)) return Answer::ng;
  rig.program.edited.add_missing_end();
  rig.program.chosen() = rig.program.edited;
  rig.program.editing = false;
  rig.program.run = {};
  return Answer::ok;
}

// Reads the n of P:DEL, P:SET and P:GET, after the comma of the formats or the colon of one example (manual 114) (1)).
std::optional<int> take_line(Reader& reader) {
  if (!reader.take(',') && !reader.take(':')) return std::nullopt;
  const auto line = reader.take_integer(1, Program::kLines);
  return line ? std::optional(static_cast<int>(*line)) : std::nullopt;
}

Answer delete_line(Rig& rig, Reader reader) {
  const auto line = take_line(reader);
  if (!line || !reader.done() || !all_rest(rig)) return Answer::ng;
  rig.program.edited.set(*line, {});
  return Answer::ok;
}

Answer set_line(Rig& rig, Reader reader) {
  const auto line = take_line(reader);
  if (!line || !reader.take(',') || !all_rest(rig)) return Answer::ng;
  const auto instruction = read_instruction(reader.rest());
  if (!instruction) return Answer::ng;
  rig.program.edited.set(*line, *instruction);
  return Answer::ok;
}

Answer delete_all(Rig& rig, Reader reader) {
  if (!reader.done() || !all_rest(rig)) return Answer::ng;
  rig.program.edited = {};
  return Answer::ok;
}

// --- commands by mode ------------------------------------------------------------------------------------------------

enum class Where { host, program, editing };

Where where_now(const Rig& rig) {
  if (!in_program_mode(rig)) return Where::host;
  return rig.program.editing ? Where::editing : Where::program;
}

struct ProgramCommand {
  std::string_view name;
  Where where;
  Answer (*run)(Rig& rig, Reader arguments);
};

// A name that begins with another name comes before it.
constexpr std::array kProgramCommands = {
    ProgramCommand{"R", Where::host, enter},
    ProgramCommand{"H", Where::program, leave},
    ProgramCommand{"P", Where::program, choose},
    ProgramCommand{"ON", Where::program, edit},
    ProgramCommand{"OFF", Where::editing, save},
    ProgramCommand{"O", Where::program, start_one_line},
    ProgramCommand{"E", Where::program, stop_program},
    ProgramCommand{"U", Where::program, pause},
    ProgramCommand{"C", Where::program, tell_completion},
    ProgramCommand{"T", Where::program, tell_trigger},
    ProgramCommand{"DEL", Where::editing, delete_line},
    ProgramCommand{"SET", Where::editing, set_line},
    ProgramCommand{"S", Where::program, start},
    ProgramCommand{"INIT", Where::editing, delete_all},
};

Answer run_command(Rig& rig, Reader reader) {
  for (const ProgramCommand& command : kProgramCommands) {
    if (!reader.take_text(command.name)) continue;
    return command.where == where_now(rig) ? command.run(rig, reader) : Answer::ng;
  }
  return Answer::ng;
}

constexpr Command kProgramCommand = {"P:", run_command};

constexpr std::array<std::string_view, 2> kGets = {"P:GET", "P:GEL"};

}  // namespace

const Command* find_program_command(std::string_view verb) {
  return verb == kProgramCommand.verb ? &kProgramCommand : nullptr;
}

// Returns true for the commands of manual 102) and 111).
bool works_in_program_mode(const Rig& rig, std::string_view command) {
  if (command.starts_with("P:")) return true;
  if (rig.program.editing) return false;
  return command == "L:E" || command.starts_with("!") || command.starts_with("Q:") || command.starts_with("SRQ:") ||
         command.starts_with("?") || command.starts_with("BEC:");
}

bool asks_for_program_line(std::string_view line) {
  return std::any_of(kGets.begin(), kGets.end(), [&](std::string_view name) { return line.starts_with(name); });
}

std::optional<std::string> answer_program_line(const Rig& rig, std::string_view line) {
  if (where_now(rig) != Where::editing) return std::nullopt;
  Reader reader(line.substr(kGets.front().size()));
  const auto number = take_line(reader);
  if (!number || !reader.done() || !all_rest(rig)) return std::nullopt;
  return rig.program.edited.at(*number).text;
}

std::string program_status(const Rig& rig) {
  const ProgramRun& run = rig.program.run;
  std::string text = fmt::format("{},{},{}", rig.program.number, static_cast<int>(run.status), run.line);
  for (const ProgramRun::Loop& loop : run.loops) text += fmt::format(",{}", loop.left);
  return text;
}

}  // namespace axisgate::shrc203::simulator
