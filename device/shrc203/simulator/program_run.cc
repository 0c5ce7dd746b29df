#include "device/shrc203/simulator/program_run.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace axisgate::shrc203::simulator {
namespace {

using Status = ProgramRun::Status;
using Step = ProgramRun::Step;

// Duration of each line, so that no program loops forever in no time.
constexpr Duration kLineTime = std::chrono::milliseconds(1);
// Interval between checks of the trigger output; TRIG is sent at most this often.
constexpr Duration kTriggerTick = std::chrono::milliseconds(1);

Duration tenths(int count) { return std::chrono::milliseconds(100) * count; }

// --- triggers --------------------------------------------------------------------------------------------------------

void tell_triggers(Rig& rig) {
  ProgramRun& run = rig.program.run;
  const std::int64_t emitted = rig.triggers.emitted(rig.now);
  if (emitted > run.triggers_reported && rig.program.reports_trigger) rig.program.tell("TRIG");
  run.triggers_reported = emitted;
}

Triggers::Target target_of(int mode) {
  constexpr std::array kTargets = {Triggers::Target::pulses, Triggers::Target::timer, Triggers::Target::scale_plus,
                                   Triggers::Target::scale_minus};
  const auto place = static_cast<std::size_t>(mode);
  return place < kTargets.size() ? kTargets[place] : Triggers::Target::none;
}

void start_triggers(Rig& rig) {
  ProgramRun& run = rig.program.run;
  rig.triggers.arm(target_of(run.trigger.mode), run.trigger.axis, std::max<std::int64_t>(run.trigger.interval, 1),
                   rig.now);
  run.triggers_reported = rig.triggers.emitted(rig.now);
  if (run.trigger.mode < Trigger::kOneShot && rig.program.reports_trigger) run.trigger_due = rig.now + kTriggerTick;
}

void disarm_triggers(Rig& rig) {
  tell_triggers(rig);
  rig.triggers.disarm(rig.now);
  rig.program.run.trigger_due.reset();
}

// Continues while the program pauses, until the motion ends.
void tell_triggers_when_due(Rig& rig) {
  ProgramRun& run = rig.program.run;
  if (!run.trigger_due || *run.trigger_due > rig.now) return;
  tell_triggers(rig);
  *run.trigger_due += kTriggerTick;
  if (!rig.motions.busy(rig.controllable)) disarm_triggers(rig);
}

void end_triggers(Rig& rig) {
  disarm_triggers(rig);
  if (rig.program.run.trigger.mode != Trigger::kOneShot) return;
  rig.triggers.fire();
  tell_triggers(rig);
}

// --- sequence of lines -----------------------------------------------------------------------------------------------

void leave(Rig& rig, Status status) {
  if (rig.program.run.step == Step::moving) disarm_triggers(rig);
  rig.program.run.status = status;
}

void complete(Rig& rig) {
  leave(rig, Status::not_executed);
  if (rig.program.reports_completion) rig.program.tell("COMP");
}

// Goes to the next line that is not NONE; lines that are NONE take no time.
void go_to(Rig& rig, int line) {
  ProgramRun& run = rig.program.run;
  const int next = rig.program.chosen().next_registered(line);
  if (next > Program::kLines) {
    complete(rig);
    return;
  }
  run.line = next;
  run.step = Step::between_lines;
  run.due = rig.now + kLineTime;
  if (run.status == Status::one_line) run.status = Status::paused;
}

void end_line(Rig& rig) { go_to(rig, rig.program.run.line + 1); }

void wait_after(Rig& rig, const Instruction& line) {
  if (line.wait_tenths == 0) {
    end_line(rig);
    return;
  }
  rig.program.run.step = Step::waiting;
  rig.program.run.due = rig.now + tenths(line.wait_tenths);
}

// --- lines that move -------------------------------------------------------------------------------------------------

// Returns the reason for which these axes cannot start or continue, as ?:L reports it (manual 41)).
std::optional<Status> obstacle(const Rig& rig, const Axes& axes) {
  if (!axes.within(rig.controllable)) return Status::other_axes;
  for (const int number : axes.list()) {
    const Axis& axis = rig.axis(number);
    const bool at_limit = axis.limit_error && !rig.options.is("limit_error_until", "next_start");
    if (axis.error_stop() || at_limit) return Status::error;
  }
  if (rig.sleeping || !rig.is_excited(axes)) return Status::unexcited;
  if (rig.motions.busy(axes)) return Status::busy;
  return std::nullopt;
}

// s is one of the speeds 1 to 4 of the memory switch SPEED (manual 89), 119)).
Speed speed_of(const Rig& rig, int axis, int number) {
  const auto saved = [&](std::string_view name) { return rig.memory.saved(name, axis, number - 1); };
  const std::int64_t maximum = saved("SPEED (F)");
  return {std::min(saved("SPEED (S)"), maximum), maximum, static_cast<int>(saved("SPEED (R)"))};
}

Kind kind_of(Pattern pattern) {
  switch (pattern) {
    case Pattern::absolute:
    case Pattern::registered:
      return Kind::absolute;
    case Pattern::line:
      return Kind::line;
    case Pattern::arc:
    case Pattern::helix:
      return Kind::arc;
    case Pattern::origin_return:
      return Kind::origin_return;
    case Pattern::logical_return:
      return Kind::logical_return;
    default:
      return Kind::relative;
  }
}

// Returns nullopt for a position that is not registered, and for a helix that does not rise along axis 3: E:3 to E:5
// have no such helix (manual 74)).
std::optional<Setting> setting_of(const Rig& rig, const Instruction& line) {
  Setting setting;
  setting.kind = kind_of(line.pattern);
  setting.axes = line.axes;
  setting.values = line.values;
  setting.arc = line.arc;
  if (line.pattern == Pattern::helix) {
    if (line.axes.has(3)) return std::nullopt;
    setting.axes.add(3);
  }
  if (line.pattern == Pattern::registered) {
    for (const int axis : line.axes.list()) {
      const auto& position = rig.saved.coordinates[static_cast<std::size_t>(line.values[index_of(axis)] - 1)];
      if (!position) return std::nullopt;
      setting.values[index_of(axis)] = position->pulses[index_of(axis)];
    }
  }
  if (line.pattern == Pattern::origin_return) return setting;
  for (const int axis : setting.axes.list()) setting.speeds[index_of(axis)] = speed_of(rig, axis, line.speed);
  return setting;
}

void move(Rig& rig, const Instruction& line) {
  const auto setting = setting_of(rig, line);
  if (const auto why = setting ? obstacle(rig, setting->axes) : Status::unexpected) {
    leave(rig, *why);
    return;
  }
  ProgramRun& run = rig.program.run;
  rig.outputs = line.output;
  if (line.trigger.mode != Trigger::kAsBefore) run.trigger = line.trigger;
  if (line.axes.empty()) {
    wait_after(rig, line);
    return;
  }
  start_triggers(rig);
  rig.motions.start_at_once(*setting, rig.now);
  run.axes = setting->axes;
  run.step = Step::moving;
}

void set_origin(Rig& rig, const Instruction& line) {
  if (const auto why = obstacle(rig, line.axes)) {
    leave(rig, *why);
    return;
  }
  for (const int axis : line.axes.list()) rig.axis(axis).set_logical_origin();
  end_line(rig);
}

// --- loops -----------------------------------------------------------------------------------------------------------

ProgramRun::Loop& loop_of(Rig& rig, const Instruction& line) {
  return rig.program.run.loops[static_cast<std::size_t>(line.nest - 1)];
}

void begin_loop(Rig& rig, const Instruction& line) {
  loop_of(rig, line) = {rig.program.run.line, line.repeats};
  end_line(rig);
}

// Manual 114) (15). An N without its F is an unexpected line.
void repeat_loop(Rig& rig, const Instruction& line) {
  ProgramRun::Loop& loop = loop_of(rig, line);
  if (loop.line == 0) {
    leave(rig, Status::unexpected);
  } else if (--loop.left > 0) {
    go_to(rig, loop.line + 1);
  } else {
    loop = {};
    end_line(rig);
  }
}

// --- one line --------------------------------------------------------------------------------------------------------

void begin_line(Rig& rig) {
  const Instruction line = rig.program.chosen().at(rig.program.run.line);
  switch (line.pattern) {
    case Pattern::relative:
    case Pattern::absolute:
    case Pattern::line:
    case Pattern::arc:
    case Pattern::helix:
    case Pattern::registered:
    case Pattern::origin_return:
    case Pattern::logical_return:
      move(rig, line);
      return;
    case Pattern::set_origin:
      set_origin(rig, line);
      return;
    case Pattern::input:
      rig.program.run.step = Step::input;
      return;
    case Pattern::loop_start:
      begin_loop(rig, line);
      return;
    case Pattern::loop_end:
      repeat_loop(rig, line);
      return;
    case Pattern::end:
      complete(rig);
      return;
    case Pattern::continuous:
      leave(rig, Status::unexpected);
      return;
    case Pattern::none:
      end_line(rig);
      return;
  }
}

void end_motion(Rig& rig, const Instruction& line) {
  const Axes moved = rig.program.run.axes;
  for (const int number : moved.list()) {
    if (rig.axis(number).limit_error) return leave(rig, Status::error);
  }
  if (const auto why = obstacle(rig, moved)) return leave(rig, *why);
  end_triggers(rig);
  wait_after(rig, line);
}

bool any_emergency(const Rig& rig) {
  const auto list = rig.controllable.list();
  return std::any_of(list.begin(), list.end(), [&](int number) { return rig.axis(number).emergency; });
}

// Continues the program if it has nothing left to wait for. A motion that runs when the program pauses continues.
void progress(Rig& rig) {
  ProgramRun& run = rig.program.run;
  if (!run.active()) return;
  if (!in_program_mode(rig)) return leave(rig, Status::not_executed);
  if (any_emergency(rig)) return leave(rig, Status::error);
  if (run.status == Status::paused) return;
  const Instruction line = rig.program.chosen().at(run.line);
  switch (run.step) {
    case Step::between_lines:
      if (run.due <= rig.now) begin_line(rig);
      return;
    case Step::moving:
      if (!rig.motions.busy(run.axes)) end_motion(rig, line);
      return;
    case Step::waiting:
      if (run.due <= rig.now) end_line(rig);
      return;
    case Step::input:
      if (rig.inputs == line.inputs) end_line(rig);
      return;
  }
}

bool waits_for_time(const Rig& rig) {
  const ProgramRun& run = rig.program.run;
  return (run.status == Status::executing || run.status == Status::one_line) &&
         (run.step == Step::between_lines || run.step == Step::waiting);
}

}  // namespace

std::vector<std::string> take_notices(Rig& rig) { return std::exchange(rig.program.notices, {}); }

bool in_program_mode(const Rig& rig) { return rig.mode == "HOST,PROGRAM"; }

std::optional<TimePoint> next_due(const Rig& rig) {
  std::optional<TimePoint> next = rig.motions.next_event();
  const auto consider = [&next](TimePoint time) { next = next ? std::min(*next, time) : time; };
  const ProgramRun& run = rig.program.run;
  if (waits_for_time(rig)) consider(run.due);
  if (run.trigger_due) consider(*run.trigger_due);
  return next;
}

void run_until(Rig& rig, TimePoint now) {
  rig.motions.process(rig.now);
  progress(rig);
  for (auto next = next_due(rig); next && *next <= now; next = next_due(rig)) {
    rig.now = std::max(rig.now, *next);
    rig.motions.process(rig.now);
    tell_triggers_when_due(rig);
    progress(rig);
  }
}

void start_program(Rig& rig, bool one_line) {
  ProgramRun& run = rig.program.run;
  run = {};
  run.status = Status::executing;
  go_to(rig, 1);
  if (one_line && run.active()) run.status = Status::one_line;
}

void pause_program(Rig& rig) { rig.program.run.status = Status::paused; }

void resume_program(Rig& rig, bool one_line) {
  rig.program.run.status = one_line ? Status::one_line : Status::executing;
}

void stop_program(Rig& rig) {
  leave(rig, Status::not_executed);
  Axes stopping;
  for (const int axis : rig.controllable.list()) {
    if (rig.axis(axis).excited) stopping.add(axis);
  }
  rig.motions.stop(stopping, rig.now);
}

}  // namespace axisgate::shrc203::simulator
