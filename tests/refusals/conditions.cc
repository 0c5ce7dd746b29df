#include "tests/refusals/conditions.h"

#include <fmt/format.h>

#include <utility>

namespace axisgate::refusals {
namespace {

using namespace shrc203;
using simulator::AxisError;

bool in_host(const Sentence& one) {
  return one.where != Where::program && one.where != Where::editing && one.where != Where::switches;
}

// Sends a line to the simulator as if a person had acted at the front panel. Q:SPC follows it, because ?:CMD reports
// the last line and must not show this one.
void told_by_another(Device& device, TimePoint now, const std::string& line) {
  device.receive(line + "\r\nQ:SPC\r\n", now);
}

// Makes H: last long: the mechanical origin is 100,000 pulses away (59)).
void slow_origin_return(simulation::Setup& setup) {
  for (auto& axis : setup.options.axes) {
    axis.origin_minimum_speed = 100;
    axis.origin_maximum_speed = 1000;
  }
}

Condition busy() {
  return {.name = "Busy",
          .manual =
              "\"In the case of Busy, it will be NG\": 45), 47) to 56), 59) to 64), 67), 69), 71) to 76), 83), "
              "85) to 92), 94), 97) to 102), 117), 127) to 136). An axis moves that nobody here has started",
          .reason = Reason::axis_busy,
          .told = "axis 1",
          .cases = ordinary([](const Sentence& one) { return one.says('B') && in_host(one); }),
          .strikes = [](Device& device, TimePoint now) { told_by_another(device, now, "H:1"); },
          .set_up = slow_origin_return,
          .never_sent = [](const Sentence& one) { return one.moves; }};
}

Condition program_busy() {
  return {.name = "Busy, in program mode",
          .manual = "\"In the case of Busy, it will be NG\": 103) to 106), 109) to 111). A program runs",
          .reason = Reason::axis_busy,
          .told = "program 1",
          .cases = ordinary([](const Sentence& one) { return one.says('B') && one.where == Where::program; }),
          .strikes = [](Device& device, TimePoint now) { told_by_another(device, now, "P:S"); },
          .strikes_early = false};
}

// Program edit mode is entered while stationary and accepts no motion command, so the moving axis was started at the
// front panel.
Condition editing_busy() {
  return {.name = "Busy, in program edit mode",
          .manual = "\"In the case of Busy, it will be NG\": 112) to 116). Nothing there shows which axes move (111))",
          .reason = Reason::device_refused,
          .told = "program edit mode",
          .cases = ordinary([](const Sentence& one) { return one.says('B') && one.where == Where::editing; }),
          .strikes =
              [](Device& device, TimePoint now) {
                device.set_mode("HOST", now);
                told_by_another(device, now, "H:1");
                device.set_mode("HOST,PROGRAM", now);
              },
          .set_up = slow_origin_return,
          .strikes_early = false};
}

Condition error(std::string what, AxisError error, std::string told) {
  return {.name = std::move(what),
          .manual = "5) names the bit. That an axis with an error takes no motion is a reading",
          .reason = Reason::device_error,
          .told = std::move(told),
          .cases = ordinary([](const Sentence& one) { return one.moves && one.where == Where::host; }),
          .strikes = [error](Device& device, TimePoint now) { device.set_error(1, error, true, now); },
          .never_sent = [](const Sentence&) { return true; }};
}

}  // namespace

std::vector<Case> ordinary(const std::function<bool(const Sentence&)>& concerned) {
  std::vector<Case> cases;
  for (const Sentence& one : sentences()) {
    // These commands are tested separately: a stop succeeds if the axes stop, and JD: needs a running jog.
    const bool apart = one.command == "L:" || one.command == "L:E" || one.command == "JD:";
    if (!apart && concerned(one)) cases.push_back({&one, one.line, one.whole(), one.way_there(), {}});
  }
  return cases;
}

std::vector<Condition> states_of_axes() {
  std::vector<Condition> all{busy(), program_busy(), editing_busy()};
  const auto excited = [](const Sentence& one) { return one.says('E'); };
  const auto moves = [](const Sentence& one) { return one.moves; };
  all.push_back({.name = "Motor excitation OFF",
                 .manual = "\"... or the motor excitation is OFF\": 59) to 65), 67) to 88), 130), 131), 135), 136)",
                 .reason = Reason::not_excited,
                 .told = "axis 1",
                 .cases = ordinary(excited),
                 .strikes = [](Device& device, TimePoint now) { device.set_excitation(1, false, now); }});
  all.push_back({.name = "Limit sensor detected",
                 .manual = "\"... or the limit sensor is detected\": 71) to 84)",
                 .reason = Reason::limit_detected,
                 .told = "axis 1",
                 .cases = ordinary([](const Sentence& one) { return one.says('L'); }),
                 .strikes = [](Device& device, TimePoint now) { device.set_limit(1, 1, true, now); }});
  all.push_back({.name = "Emergency stop",
                 .manual = "66) \"put them in an emergency stop state ... To cancel, send the BEC: command\"",
                 .reason = Reason::emergency_stopped,
                 .told = "emergency stop",
                 .cases = ordinary(excited),
                 .strikes = [](Device& device, TimePoint now) { device.press_emergency(now); },
                 .never_sent = moves});
  all.push_back(error("Scale error S1", AxisError::scale, "S1"));
  all.push_back(error("Disconnection error S2", AxisError::disconnection, "S2"));
  all.push_back(error("Hunting error S3", AxisError::hunting, "S3"));
  all.push_back(error("Overflow error S4", AxisError::overflow, "S4"));
  all.push_back(error("System error S7", AxisError::system, "S7"));
  all.push_back(error("Motor driver overheat error S10", AxisError::overheat, "S10"));
  all.push_back({.name = "Asleep",
                 .manual = "47) SLEEP:1. Which commands it refuses is a reading: what moves",
                 .reason = Reason::not_excited,
                 .told = "sleeps",
                 .cases = ordinary(moves),
                 .strikes = [](Device& device, TimePoint now) { device.set_sleep(true, now); }});
  return all;
}

std::vector<Condition> modes() {
  const auto nothing_sent = [](const Sentence&) { return true; };
  std::vector<Condition> all;
  for (const char* mode : {"MANUAL", "REMOTE", "TEACHING", "EDIT", "TEST"}) {
    all.push_back({.name = fmt::format("{} mode", mode),
                   .manual = "4. \"*IDN? ?:MODE ?:CMD MODE: can be used in all operation modes\": the others in HOST",
                   .reason = Reason::wrong_mode,
                   .told = mode,
                   .cases = ordinary([](const Sentence& one) { return one.where != Where::everywhere; }),
                   .strikes = [mode](Device& device, TimePoint now) { device.set_mode(mode, now); },
                   .never_sent = nothing_sent});
  }
  all.push_back({.name = "Command format HIT",
                 .manual = "50) FMT:HIT: this volume is of SHOT_FC",
                 .reason = Reason::wrong_mode,
                 .told = "HIT",
                 .cases = ordinary([](const Sentence& one) {
                   const bool of_both =
                       one.command == "?:FMT" || one.command == "FMT:" || one.command == "!:" || one.command == "Q:";
                   return one.where != Where::everywhere && !of_both && in_host(one);
                 }),
                 .strikes = [](Device& device, TimePoint now) { device.set_format("HIT", now); },
                 .never_sent = nothing_sent});
  all.push_back({.name = "Program mode, by somebody else",
                 .manual = "102) lists what works there",
                 .reason = Reason::wrong_mode,
                 .told = "HOST,PROGRAM",
                 .cases = ordinary([](const Sentence& one) { return one.where == Where::host; }),
                 .strikes = [](Device& device, TimePoint now) { device.set_mode("HOST,PROGRAM", now); }});
  all.push_back({.name = "Memory switch edit mode, by somebody else",
                 .manual = "117) lists what works there",
                 .reason = Reason::wrong_mode,
                 .told = "HOST,MS",
                 .cases = ordinary([](const Sentence& one) {
                   return one.where == Where::host || one.where == Where::host_and_program;
                 }),
                 .strikes = [](Device& device, TimePoint now) { device.set_mode("HOST,MS", now); },
                 .never_sent = nothing_sent});
  const Sentence &stop = sentence("L:"), &emergency = sentence("L:E");
  all.push_back(
      {.name = "A stop in MANUAL mode",
       .manual = "4., the last note. The stop stays open, and is sent again in HOST mode",
       .reason = Reason::wrong_mode,
       .cases = {{&stop, stop.line, {stop.line}, {}, {}}, {&emergency, emergency.line, {emergency.line}, {}, {}}},
       .strikes = [](Device& device, TimePoint now) { device.set_mode("MANUAL", now); },
       .strikes_early = false});
  return all;
}

std::vector<Condition> conditions() {
  std::vector<Condition> all = states_of_axes();
  for (const auto part : {modes, wrong_lines}) {
    for (Condition& one : part()) all.push_back(std::move(one));
  }
  return all;
}

}  // namespace axisgate::refusals
