// Lines that are refused for their content, or because something that they need is missing.
#include "tests/refusals/conditions.h"

namespace axisgate::refusals {
namespace {

using namespace shrc203;

const auto kNothingSent = [](const Sentence&) { return true; };

Case wrong(std::string_view command, const std::string& line) {
  const Sentence& one = sentence(command);
  return {&one, line, one.with(line), one.way_there(), {}};
}

// Returns a case without the lines that enter and leave the command's mode.
Case bare(const Sentence& one) { return {&one, one.line, {one.line}, {}, {}}; }

std::vector<Case> bare_in_host() {
  std::vector<Case> cases;
  for (const Sentence& one : sentences()) {
    const bool elsewhere = one.where == Where::program || one.where == Where::editing || one.where == Where::switches;
    if (elsewhere) cases.push_back(bare(one));
  }
  return cases;
}

std::vector<Case> edit_commands_in_program_mode() {
  std::vector<Case> cases;
  for (const Sentence& one : sentences()) {
    if (one.where == Where::editing) cases.push_back({&one, one.line, {"P:R", one.line, "P:H"}, {"P:R"}, {}});
  }
  return cases;
}

std::vector<Case> out_of_range() {
  std::vector<Case> cases;
  for (const Sentence& one : sentences()) {
    for (const std::string& line : one.out_of_range) cases.push_back(wrong(one.command, line));
  }
  return cases;
}

std::vector<Case> malformed() {
  std::vector<Case> cases;
  for (const Sentence& one : sentences()) {
    if (!one.malformed.empty()) cases.push_back(wrong(one.command, one.malformed));
  }
  return cases;
}

std::vector<Case> of_an_axis_that_is_not_there() {
  std::vector<Case> cases;
  for (const Sentence& one : sentences()) {
    if (one.third.empty()) continue;
    Case third = wrong(one.command, one.third);
    if (one.command == "JD:") third.simulator_before = {};
    cases.push_back(std::move(third));
  }
  return cases;
}

std::vector<Condition> about_values() {
  std::vector<Condition> all;
  all.push_back({.name = "Value out of its range",
                 .manual = "the \"Setting range\" of each parameter, and \"Please set it to the minimum speed (S) or "
                           "higher\"",
                 .reason = Reason::out_of_range,
                 .cases = out_of_range(),
                 .never_sent = kNothingSent});
  all.push_back({.name = "Another form than the manual's",
                 .manual = "3. \"Make sure the command string is correct\"",
                 .reason = Reason::malformed_line,
                 .cases = malformed(),
                 .never_sent = kNothingSent});
  all.push_back({.name = "Axis that is not controllable",
                 .manual = "44) and the memory switch AXIS; here it is 1 + 2. That such a letter is NG is a reading",
                 .reason = Reason::unknown_axis,
                 .told = "3",
                 .cases = of_an_axis_that_is_not_there(),
                 .set_up = [](simulation::Setup& setup) { setup.options.axis_setting = 3; },
                 .never_sent = kNothingSent});
  all.push_back(
      {.name = "All points on a straight line",
       .manual = "73), 76), 79), 82) \"an arc cannot be specified, so NG is replied\"",
       .reason = Reason::invalid_request,
       .told = "one line",
       .cases = {wrong("E:2", "E:2A0+P100+P100+P200+P200"), wrong("E:5", "E:5A0+P100+P100+P200+P200+P10"),
                 wrong("EP:2", "EP:2A0+P100+P100+P200+P200"), wrong("EP:5", "EP:5A0+P100+P100+P200+P200+P10")},
       .never_sent = kNothingSent});
  all.push_back({.name = "S above F, or F below S",
                 .manual = "68), 89) \"Please set it to the minimum speed (S) or higher\"; 90), 91) set one of them, S "
                           "is 1000 and F is 50000",
                 .reason = Reason::out_of_range,
                 .told = "F",
                 .cases = {wrong("DS:", "DS:1F50001"), wrong("DF:", "DF:1F999")}});
  return all;
}

std::vector<Condition> about_order() {
  const Sentence &go = sentence("G"), &go_of = sentence("G:"), &faster = sentence("JD:");
  std::vector<Condition> all;
  all.push_back({.name = "Nothing set before G",
                 .manual = "85), 86) \"After sending the ... commands\"",
                 .reason = Reason::incomplete_transaction,
                 .told = "alone",
                 .cases = {bare(go), bare(go_of)},
                 .never_sent = kNothingSent});
  all.push_back({.name = "No jog runs",
                 .manual = "93) \"It can be used only during operation with the J: command\"",
                 .reason = Reason::invalid_request,
                 .told = "jog",
                 .cases = {bare(faster)},
                 .never_sent = kNothingSent});
  const Sentence& way = sentence("M:");
  const auto with_a_prebuffer = [&](const Sentence& start) {
    return Case{&start, start.line, {way.line, start.line}, {way.line}, {}};
  };
  all.push_back({.name = "A stale prebuffer",
                 .manual = "2. does not say what a start does where M: and MP: are both set; here it is refused. "
                           "Somebody has set MP: for axis 1 and never started it",
                 .reason = Reason::stale_setpoint,
                 .told = "stale prebuffer",
                 .cases = {with_a_prebuffer(go), with_a_prebuffer(go_of)},
                 .strikes = [](Device& device, TimePoint now) { device.receive("MP:1+P100\r\nQ:SPC\r\n", now); },
                 .set_up = [](simulation::Setup& setup) { (void)setup.options.set("go_with_both_buffers", "ng"); },
                 .never_sent = kNothingSent});
  all.push_back({.name = "Nothing saved under that number",
                 .manual = "130), 131), 135), 136) \"Moves to the position registered\"; 129), 134)",
                 .reason = Reason::not_found,
                 .told = "number 5",
                 .cases = {wrong("PIT:GET", "PIT:GET,5"), wrong("PIT:G", "PIT:G,5"), wrong("PIT:GRT", "PIT:GRT,5"),
                           wrong("PAV:GET", "PAV:GET,5"), wrong("PAV:G", "PAV:G,5"), wrong("PAV:GRT", "PAV:GRT,5")},
                 .never_sent = [](const Sentence& one) { return one.moves; }});
  all.push_back({.name = "Memory switch CONFIG is ON",
                 .manual = "55) \"If the memory switch AXIS - CONFIG is ON, this command is invalid\"",
                 .reason = Reason::device_refused,
                 .told = "CONFIG",
                 .cases = {wrong("S:", "S:1,100")},
                 .device_before = {"MS:ON", "MS:SET,3,9,1", "MS:OFF"}});
  return all;
}

std::vector<Condition> about_other_modes() {
  const Sentence& pause = sentence("P:U");
  std::vector<Condition> all;
  all.push_back({.name = "Without the way to its mode",
                 .manual = "the lists of 102), 111) and 117): sent in HOST",
                 .reason = Reason::incomplete_transaction,
                 .told = "works in",
                 .cases = bare_in_host(),
                 .never_sent = kNothingSent});
  all.push_back({.name = "In program mode instead of program edit mode",
                 .manual = "the list of 102)",
                 .reason = Reason::incomplete_transaction,
                 .told = "program edit mode",
                 .cases = edit_commands_in_program_mode(),
                 .never_sent = kNothingSent});
  all.push_back({.name = "No program runs",
                 .manual = "108) \"Pauses program operation\"",
                 .reason = Reason::device_refused,
                 .told = "program",
                 .cases = {{&pause, "P:U0", {"P:R", "P:U0", "P:H"}, {"P:R"}, {}}}});
  all.push_back({.name = "Step that the program does not take",
                 .manual = "114) K \"enable 2 or more axes\"; CM, E \"a command error will occur\"",
                 .reason = Reason::device_refused,
                 .told = "program edit mode",
                 .cases = {wrong("P:SET", "P:SET,1,K,1,0,0,100,0,0,0,1,0,5"),
                           wrong("P:SET", "P:SET,1,CM,1,1,0,100,100,0,0,1,0,0"),
                           wrong("P:SET", "P:SET,1,E,1,1,1,2,100,200,90,0,1,0,5")}});
  all.push_back({.name = "Number or value that the memory switch does not have",
                 .manual = "119) to 126) \"OK or NG\": another volume says which they are",
                 .reason = Reason::device_refused,
                 .told = "memory switch",
                 .cases = {wrong("MS:SET", "MS:SET,0,1,9"), wrong("MS:SET", "MS:SET,0,999,1"),
                           wrong("MS:SETK", "MS:SETK,0,6,0,1"), wrong("MS:GET", "MS:GET,0,999"),
                           wrong("MS:DEF", "MS:DEF,0,999"), wrong("MS:DEFR", "MS:DEFR,0,999")}});
  return all;
}

}  // namespace

std::vector<Condition> wrong_lines() {
  std::vector<Condition> all = about_values();
  for (const auto part : {about_order, about_other_modes}) {
    for (Condition& one : part()) all.push_back(std::move(one));
  }
  return all;
}

}  // namespace axisgate::refusals
