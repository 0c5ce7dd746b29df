// CLI11 takes eight seconds to compile: only this unit, setting_options.cc and mill_options.cc include it.
#include "clients/axisctl/options.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>

#include "clients/axisctl/addresses.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/help_topics.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verb_options.h"

namespace axisgate::axisctl {

CLI::App* add_verb(CLI::App& app, Options& options, Verb verb, const char* name, const char* description) {
  CLI::App* added = app.add_subcommand(name, description);
  added->fallthrough();
  added->footer(help_text(name));
  added->callback([&options, verb] { options.verb = verb; });
  return added;
}

void add_wait(CLI::App& verb, Options& options) {
  verb.add_option("--wait", options.wait_s, "wait at most so long for axes under another lease")
      ->check(CLI::Range(1, 86'400))
      ->type_name("S");
}

void add_axes(CLI::App& verb, Options& options) {
  verb.add_option("AXES", options.axes, "numbers or names; none: all axes")->delimiter(',')->type_name("");
}

namespace {

constexpr const char* kExitCodes = R"(

Exit codes: 0 done; 1 the motion failed, was stopped, or its outcome is unknown; a replay differs; 2 wrong usage;
3 refused (bad request or the device's state); 4 unavailable (no daemon, or the line is down); 5 deadline passed.

Not a safety function: the wired emergency stop remains your responsibility.)";

void add_waiting(CLI::App& verb, Options& options) {
  verb.add_flag("--no-wait", options.no_wait, "return at the start, not at the outcome");
}

void add_speed(CLI::App& verb, Options& options) {
  verb.add_option("--speed", options.speed, "maximum speed, as 2mm/s; of a path: for segments without their own")
      ->type_name("SPEED");
  verb.add_option("--acceleration-ms", options.acceleration_ms, "time from minimum to maximum speed")
      ->check(CLI::Range(1, 1000))
      ->type_name("MS");
}

void add_manner_of_path(CLI::App& verb, Options& options) {
  verb.add_flag("--absolute", options.absolute, "the amounts are positions, not displacements");
  add_speed(verb, options);
  add_waiting(verb, options);
  add_wait(verb, options);
}

void add_scan(CLI::App& app, Options& options) {
  CLI::App* scan = add_verb(app, options, Verb::scan, "scan", "run over a range with pulses at the trigger output");
  scan->add_option("AXIS", options.axis, "number or name")->required()->type_name("");
  scan->add_option("FROM", options.from, "where the range begins, as 0mm")->required()->type_name("");
  scan->add_option("TO", options.to, "where it ends, as 1mm")->required()->type_name("");
  scan->add_option("--every", options.every, "interval of the trigger pulses, 2 to 30000 drive pulses")
      ->required()
      ->check(CLI::Range(2, 30'000))
      ->type_name("PULSES");
  scan->add_flag("--scale", options.by_scale, "the interval is in scale pulses, not drive pulses");
  add_speed(*scan, options);
  add_waiting(*scan, options);
  add_wait(*scan, options);
}

void add_motion_verbs(CLI::App& app, Options& options) {
  CLI::App* home = add_verb(app, options, Verb::home, "home", "home axes: the mechanical origin return");
  add_axes(*home, options);
  home->add_flag("--logical", options.logical, "return to the logical origin instead");
  add_waiting(*home, options);
  add_wait(*home, options);

  CLI::App* move = add_verb(app, options, Verb::move, "move", "move axes to positions, or by displacements");
  move->add_option("AXIS=AMOUNT", options.places, "as 1=+5mm 2=-200um")->required()->type_name("");
  move->add_flag("--relative", options.relative, "the amounts are displacements from the present positions");
  move->add_option("--approach", options.approach, "the last distance of each axis to its target, as 10um: from below")
      ->type_name("AMOUNT");
  add_speed(*move, options);
  add_waiting(*move, options);
  add_wait(*move, options);

  CLI::App* path = add_verb(app, options, Verb::path, "path", "run segments one after another without a halt");
  path->add_option("FILE", options.file, "one segment a line; - is the standard input")->required()->type_name("");
  add_manner_of_path(*path, options);
  CLI::App* line = add_verb(app, options, Verb::line, "line", "run a straight line");
  line->add_option("AXIS=AMOUNT", options.lines, "as 1=1mm 2=-500um")->required()->type_name("");
  add_manner_of_path(*line, options);
  CLI::App* arc = add_verb(app, options, Verb::arc, "arc", "run a circle, an arc or a helix");
  arc->add_option("COURSE", options.lines, "as around 1=0 2=1mm ccw 90deg")->required()->type_name("");
  add_manner_of_path(*arc, options);
  add_scan(app, options);

  CLI::App* jog = add_verb(app, options, Verb::jog, "jog", "run axes until Ctrl-C");
  jog->add_option("AXIS=DIRECTION", options.places, "as 1=+ 2=-")->required()->type_name("");
  jog->add_option("--speed", options.speed, "as 1mm/s; none: the minimum speed of the axis")->type_name("SPEED");
  jog->add_option("--seconds", options.seconds, "end after this time")->check(CLI::Range(1, 1'000'000))->type_name("S");
  add_wait(*jog, options);

  add_axes(*add_verb(app, options, Verb::stop, "stop", "slow down and stop"), options);
  add_verb(app, options, Verb::estop, "estop", "emergency stop: stop all axes at once and latch, until `clear`");
  add_verb(app, options, Verb::rearm, "rearm", "allow your motion again after a stop by another caller");
}

void add_questions(CLI::App& app, Options& options) {
  add_verb(app, options, Verb::devices, "devices", "show the configured devices");
  add_verb(app, options, Verb::status, "status", "show line, controller and axes");
  add_verb(app, options, Verb::position, "position", "show the positions of the axes, read now");
}

void add_other_verbs(CLI::App& app, Options& options) {
  add_axes(*add_verb(app, options, Verb::clear, "clear", "clear limit, overflow and emergency errors"), options);
  CLI::App* exec = add_verb(app, options, Verb::exec, "exec", "send the controller's own commands as one transaction");
  exec->add_option("LINE", options.lines, "as '?:P1'")->required()->type_name("");
  CLI::App* watch = add_verb(app, options, Verb::watch, "watch", "print every event with its revision");
  watch->add_option("--from", options.from_revision, "the first revision wanted; none: from now on")
      ->type_name("REVISION");
  CLI::App* commands =
      add_verb(app, options, Verb::commands, "commands", "show the table of the controller's commands");
  commands->add_option("COMMAND", options.command, "show one command with its parameters, as M:")->type_name("");
}

void add_simulator_verb(CLI::App& app, Options& options) {
  CLI::App* sim = add_verb(app, options, Verb::sim, "sim", "do what a person can do at a simulated device");
  sim->add_option("COMMAND", options.lines, "`help` lists them")->required()->type_name("");
}

void add_recording_verbs(CLI::App& app, Options& options) {
  CLI::App* record = add_verb(app, options, Verb::record, "record",
                              "print the recording of the line: the last minutes, then until Ctrl-C");
  record->add_option("--output", options.output, "the file to write; none: the standard output")->type_name("FILE");
  CLI::Option* no_follow = record->add_flag("--no-follow", options.no_follow, "only the last minutes");
  CLI::Option* only_new = record->add_flag("--new", options.only_new, "without the last minutes");
  CLI::Option* seconds = record->add_option("--seconds", options.seconds, "end after this time");
  seconds->check(CLI::Range(1, 1'000'000))->type_name("S");
  no_follow->excludes(only_new)->excludes(seconds);

  CLI::App* replay = add_verb(app, options, Verb::replay, "replay",
                              "feed a recording to this version, and report what it does differently");
  replay->add_option("FILE", options.file, "a recording or a support report; - is the standard input")
      ->required()
      ->type_name("");

  CLI::App* support = add_verb(app, options, Verb::support, "support",
                               "write a support report, without serial numbers and names of people");
  support->add_option("--output", options.output, "none: axisgate-support-TIME.txt; - is the standard output")
      ->type_name("FILE");
}

void add_lease_verbs(CLI::App& app, Options& options) {
  CLI::App* lease = app.add_subcommand("lease", "leases: run, list, hand-over");
  lease->require_subcommand(1);
  lease->fallthrough();
  lease->footer(help_text("lease"));
  CLI::App* run = add_verb(*lease, options, Verb::lease_run, "run",
                           "run a command, for instance a shell, under a lease over the axes");
  run->add_option("--axes", options.axes, "numbers or names; none: the whole device")
      ->delimiter(',')
      ->type_name("AXES");
  add_wait(*run, options);
  run->add_flag("--take-over", options.take_over, "stop the axes and end all other leases over them")
      ->excludes("--wait");
  run->add_option("--at-loss", options.at_loss, "what happens to motion when this program is cut off")
      ->check(CLI::IsMember({"finish", "stop", "stop-and-release"}))
      ->capture_default_str();
  run->add_option("--purpose", options.purpose, "shown to other callers")->type_name("TEXT");
  run->add_option("COMMAND", options.lines, "the command, after --")->required()->type_name("");
  run->positionals_at_end();
  CLI::App* list = add_verb(*lease, options, Verb::lease_list, "list", "show leases, waiting callers and latches");
  list->add_flag("--follow", options.follow, "show every change, until Ctrl-C");
  CLI::App* hand_over = add_verb(*lease, options, Verb::lease_hand_over, "hand-over",
                                 "inside `lease run`: give the axes to a waiting caller");
  hand_over->add_option("HOLDER", options.holder, "the waiting caller, as `lease list` shows it: 'unix bert'")
      ->required()
      ->type_name("");
}

void add_access_verbs(CLI::App& app, Options& options) {
  add_verb(app, options, Verb::who_am_i, "whoami", "show your name and role, as the daemon identifies you");
  CLI::App* token = app.add_subcommand("token", "for administrators: create, list, revoke");
  token->require_subcommand(1);
  token->fallthrough();
  token->footer(help_text("token"));
  CLI::App* create = add_verb(*token, options, Verb::token_create, "create",
                              "create a token and print it; its caller sets AXISGATE_TOKEN to it");
  create->add_option("NAME", options.name, "the name: NAME calls as 'token NAME'")->required()->type_name("");
  create->add_option("--role", options.role, "what its caller may do")
      ->check(CLI::IsMember({"observer", "operator", "admin"}))
      ->capture_default_str();
  create->add_option("--days", options.days, "days until it expires")
      ->check(CLI::Range(1, 3650))
      ->capture_default_str()
      ->type_name("DAYS");
  add_verb(*token, options, Verb::token_list, "list", "show the tokens, with role and expiry");
  CLI::App* revoke =
      add_verb(*token, options, Verb::token_revoke, "revoke", "refuse all further calls with this token");
  revoke->add_option("NAME", options.name, "as `token list` shows it")->required()->type_name("");
}

void add_target(CLI::App& app, Target& target) {
  app.add_option("--target", target.address, "the daemon: a socket's path or HOST:PORT; none: the local one")
      ->envname("AXISGATE_TARGET")
      ->type_name("ADDRESS");
  app.add_flag("--tls", target.tls, "the daemon is on another machine ([network] of its configuration)");
  app.add_option("--ca", target.ca, "the authority of its certificate; implies --tls; none: those of this machine")
      ->envname("AXISGATE_CA")
      ->type_name("FILE");
  CLI::Option* certificate =
      app.add_option("--certificate", target.certificate, "your certificate; otherwise set AXISGATE_TOKEN to a token")
          ->envname("AXISGATE_CERTIFICATE")
          ->type_name("FILE");
  CLI::Option* key =
      app.add_option("--key", target.key, "the key of your certificate")->envname("AXISGATE_KEY")->type_name("FILE");
  certificate->needs(key);
  key->needs(certificate);
}

void add_position_verbs(CLI::App& app, Options& options) {
  CLI::App* save = add_verb(app, options, Verb::save, "save", "save the present position under a name");
  save->add_flag("--coordinates", options.coordinates, "save the coordinates, not the physical position");
  save->add_flag("--keep", options.keep, "do not replace a saved position");
  add_verb(app, options, Verb::positions, "positions", "show the saved positions");
  CLI::App* go = add_verb(app, options, Verb::go, "go", "move to a saved position");
  add_waiting(*go, options);
  CLI::App* forget = add_verb(app, options, Verb::forget, "forget", "delete a saved position");
  for (CLI::App* verb : {save, go, forget}) {
    verb->add_option("NAME", options.name, "1 to 40 letters, digits, - and _")->required()->type_name("");
    add_wait(*verb, options);
  }
}

bool writes_text_only(Verb verb) { return verb == Verb::record || verb == Verb::replay || verb == Verb::support; }

int list_examples() {
  for (const HelpTopic& topic : help_topics()) print_line(topic.examples);
  return kDone;
}

int show_help(CLI::App& app, const std::string& topic) {
  app.clear();  // or CLI11 would show the help of the verb `help`
  if (topic.empty()) {
    print_line(app.help());
    return kDone;
  }
  try {
    print_line(app.get_subcommand(topic)->help("axisctl"));
    return kDone;
  } catch (const CLI::OptionNotFound&) {
  }
  const std::string text = help_text(topic);
  if (!text.empty()) {
    print_line(text);
    return kDone;
  }
  print_failure(usage("there is no verb and no topic \"" + topic + '"', "axisctl help lists them"));
  return kUsage;
}

int refuse(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = error.what();
  if (app.get_subcommands().empty()) {
    const std::vector<std::string> words = app.remaining();
    message = words.empty() ? "no verb was given" : '"' + words.front() + "\" is not a verb";
  }
  print_failure(usage(message, "axisctl help lists the verbs and their options"));
  return kUsage;
}

}  // namespace

std::variant<Options, int> parse_options(int argument_count, char** arguments) {
  Options options;
  std::string help_topic;
  bool examples = false;
  CLI::App app{"Moves stages and watches them through axisgated.", "axisctl"};
  app.require_subcommand(1);
  add_target(app, options.target);
  app.add_option("--device", options.device, "the device; none: the only one")->type_name("NAME");
  app.add_flag("--json", options.json, "print one JSON object per line");
  app.get_formatter()->label("SUBCOMMAND", "VERB");
  app.get_formatter()->label("Subcommands", "Verbs");
  app.get_formatter()->label("REQUIRED", "");
  add_questions(app, options);
  add_motion_verbs(app, options);
  add_position_verbs(app, options);
  add_other_verbs(app, options);
  add_lease_verbs(app, options);
  add_access_verbs(app, options);
  add_simulator_verb(app, options);
  add_recording_verbs(app, options);
  add_setting_verbs(app, options);
  add_mill_verbs(app, options);
  CLI::App* help =
      app.add_subcommand("help", "show this, one verb, or: units, paths, scans, leases, settings, triggers");
  help->add_option("TOPIC", help_topic)->type_name("");
  help->add_flag("--list-examples", examples)->group("");
  app.footer(help_text("") + kExitCodes);  // last, or every verb's help would repeat it
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::CallForHelp& call) {
    return app.exit(call);
  } catch (const CLI::ParseError& error) {
    return refuse(app, error);
  }
  if (help->parsed()) return examples ? list_examples() : show_help(app, help_topic);
  if (options.json && writes_text_only(options.verb)) {
    print_failure(usage("this verb has no JSON output", "leave out --json"));
    return kUsage;
  }
  Target& target = options.target;
  target.address = address(std::move(target.address));
  target.tls = target.tls || !target.ca.empty() || !target.certificate.empty();
  options.device = resource(options.device);
  return options;
}

}  // namespace axisgate::axisctl
