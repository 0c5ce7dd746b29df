// Parsing of the command line. CLI11 takes eight seconds to compile, so only this file, option_bytes.cc,
// setting_options.cc, history_options.cc and mill_options.cc include it.
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
  verb.add_option("--wait", options.wait_s, "if another lease holds the axes, wait up to S seconds for them")
      ->check(CLI::Range(1, 86'400))
      ->type_name("S");
}

void add_axes(CLI::App& verb, Options& options) {
  verb.add_option("AXES", options.axes, "numbers or names (default: all axes)")->delimiter(',')->type_name("");
}

namespace {

constexpr const char* kExitCodes = R"(

Exit codes:
  0    done
  1    the motion or the mill job failed, was stopped, or its outcome is unknown; or a replay differs; or a mill job
       has an error, or is not confirmed
  2    wrong usage
  3    refused: a wrong request, a lease of somebody else, or the state of the controller
  4    unavailable: no daemon, or the serial connection is down
  5    not in time: the axes did not become free, or the daemon did not answer
  130  Ctrl-C while axisctl waited for a motion or a mill job

axisctl is not a safety function. Keep the wired emergency stop within reach.)";

void add_waiting(CLI::App& verb, Options& options) {
  verb.add_flag("--no-wait", options.no_wait, "exit once the motion has started; do not wait for its end");
}

void add_speed(CLI::App& verb, Options& options, const char* description) {
  verb.add_option("--speed", options.speed, description)->type_name("SPEED");
  verb.add_option("--acceleration-ms", options.acceleration_ms,
                  "time in ms to speed up from the minimum to the maximum speed, and to slow down")
      ->check(CLI::Range(1, 1000))
      ->type_name("MS");
}

void add_manner_of_path(CLI::App& verb, Options& options) {
  verb.add_flag("--absolute", options.absolute, "the amounts are positions, not distances");
  add_speed(verb, options, "speed along the path, e.g. 2mm/s, for segments without speed=");
  add_waiting(verb, options);
  add_wait(verb, options);
}

void add_scan(CLI::App& app, Options& options) {
  CLI::App* scan =
      add_verb(app, options, Verb::scan, "scan", "move over a range and give trigger pulses at equal distances");
  scan->add_option("AXIS", options.axis, "number or name")->required()->type_name("");
  scan->add_option("FROM", options.from, "position where the range begins, e.g. 0mm")->required()->type_name("");
  scan->add_option("TO", options.to, "position where it ends, e.g. 1mm")->required()->type_name("");
  scan->add_option("--every", options.every, "interval of the trigger pulses, in drive pulses (see below)")
      ->required()
      ->check(CLI::Range(2, 30'000))
      ->type_name("PULSES");
  scan->add_flag("--scale", options.by_scale,
                 "count the pulses of the scale (the encoder), not the drive pulses of the motor");
  add_speed(*scan, options, "speed over the range, e.g. 200um/s (default: the maximum speed of the axis)");
  add_waiting(*scan, options);
  add_wait(*scan, options);
}

void add_motion_verbs(CLI::App& app, Options& options) {
  CLI::App* home =
      add_verb(app, options, Verb::home, "home", "home axes: find the mechanical origin, which becomes coordinate 0");
  add_axes(*home, options);
  home->add_flag("--logical", options.logical, "move to the logical origin instead: coordinate 0");
  add_waiting(*home, options);
  add_wait(*home, options);

  CLI::App* move =
      add_verb(app, options, Verb::move, "move", "move axes to positions, or with --relative by distances");
  move->add_option("AXIS=AMOUNT", options.places, "where each axis moves, e.g. 1=5mm 2=-0.2mm")
      ->required()
      ->type_name("");
  move->add_flag("--relative", options.relative, "the amounts are distances from the present positions");
  move->add_option(
          "--approach", options.approach,
          "reach the target over this last distance in + direction, e.g. 10um; in - direction: --approach=-10um")
      ->type_name("AMOUNT");
  add_speed(*move, options, "maximum speed of each axis, e.g. 2mm/s (default: see `axisctl speed`)");
  add_waiting(*move, options);
  add_wait(*move, options);

  CLI::App* path =
      add_verb(app, options, Verb::path, "path", "run a continuous path: lines and arcs without a stop between them");
  path->add_option("FILE", options.file,
                   "one segment per line, e.g. 1=1mm 2=-500um speed=2mm/s; - reads the standard input")
      ->required()
      ->type_name("");
  add_manner_of_path(*path, options);
  CLI::App* line = add_verb(app, options, Verb::line, "line", "run a straight line: the axes start and end together");
  line->add_option("AXIS=AMOUNT", options.lines, "distance of each axis, e.g. 1=1mm 2=-500um")
      ->required()
      ->type_name("");
  add_manner_of_path(*line, options);
  CLI::App* arc = add_verb(app, options, Verb::arc, "arc", "run a circle, an arc or a helix");
  arc->add_option("COURSE", options.lines, "e.g. around 1=0 2=1mm ccw 90deg (see `axisctl help paths`)")
      ->required()
      ->type_name("");
  add_manner_of_path(*arc, options);
  add_scan(app, options);

  CLI::App* jog = add_verb(app, options, Verb::jog, "jog", "move axes until Ctrl-C, which stops them");
  jog->add_option("AXIS=DIRECTION", options.places, "direction of each axis, e.g. 1=+ 2=-")->required()->type_name("");
  jog->add_option("--speed", options.speed, "e.g. 1mm/s (default: the minimum speed of the axis)")->type_name("SPEED");
  jog->add_option("--seconds", options.seconds, "stop the axes after S seconds")
      ->check(CLI::Range(1, 1'000'000))
      ->type_name("S");
  add_wait(*jog, options);

  add_axes(*add_verb(app, options, Verb::stop, "stop", "slow down and stop axes, also those that others move"),
           options);
  add_verb(app, options, Verb::estop, "estop", "emergency stop: stop all axes at once; no motion until `clear`");
  add_verb(app, options, Verb::rearm, "rearm",
           "after a stop by somebody else: allow your motions again; moves nothing");
}

void add_questions(CLI::App& app, Options& options) {
  add_verb(app, options, Verb::devices, "devices", "show the configured devices");
  add_verb(app, options, Verb::status, "status", "show the serial connection, the controller and the axes");
  add_verb(app, options, Verb::position, "position", "read and show the present positions of the axes");
}

void add_other_verbs(CLI::App& app, Options& options) {
  add_axes(*add_verb(app, options, Verb::clear, "clear",
                     "for administrators: clear limit, overflow and emergency-stop errors"),
           options);
  CLI::App* exec = add_verb(app, options, Verb::exec, "exec",
                            "send raw controller commands; no motion of other callers comes between");
  exec->add_option("LINE", options.lines, "raw controller command, e.g. '?:P1'; `axisctl commands` lists them")
      ->required()
      ->type_name("");
  CLI::App* watch = add_verb(app, options, Verb::watch, "watch",
                             "print every event (motions, stops, errors), each with its revision: its number");
  watch->add_option("--from", options.from_revision, "the first event wanted (default: the next one)")
      ->type_name("REVISION");
  CLI::App* commands = add_verb(app, options, Verb::commands, "commands", "list the raw commands of the controller");
  commands->add_option("COMMAND", options.command, "show one command with its parameters, e.g. M:")->type_name("");
}

void add_simulator_verb(CLI::App& app, Options& options) {
  CLI::App* sim =
      add_verb(app, options, Verb::sim, "sim", "simulator only: press buttons, switch inputs, trip limits, unplug");
  sim->add_option("COMMAND", options.lines, "`help` lists them")->required()->type_name("");
}

void add_recording_verbs(CLI::App& app, Options& options) {
  CLI::App* record = add_verb(app, options, Verb::record, "record",
                              "print the serial traffic: the last minutes, then all that follows until Ctrl-C");
  record->add_option("--output", options.output, "the file to write (default: the standard output)")->type_name("FILE");
  CLI::Option* no_follow = record->add_flag("--no-follow", options.no_follow, "only the last minutes");
  CLI::Option* only_new = record->add_flag("--new", options.only_new, "without the last minutes");
  CLI::Option* seconds = record->add_option("--seconds", options.seconds, "end after this time");
  seconds->check(CLI::Range(1, 1'000'000))->type_name("S");
  no_follow->excludes(only_new)->excludes(seconds);

  CLI::App* replay = add_verb(app, options, Verb::replay, "replay",
                              "for developers: run recorded traffic through this version; moves nothing");
  replay->add_option("FILE", options.file, "a recording or a support report; - reads the standard input")
      ->required()
      ->type_name("");

  CLI::App* support = add_verb(app, options, Verb::support, "support",
                               "write a support report, without serial numbers and names of people");
  support
      ->add_option("--output", options.output,
                   "the file to write (default: axisgate-support-TIME.txt); - is the standard output")
      ->type_name("FILE");
}

void add_lease_verbs(CLI::App& app, Options& options) {
  CLI::App* lease = app.add_subcommand("lease", "exclusive use of axes: run, list, hand-over");
  lease->require_subcommand(1);
  lease->fallthrough();
  lease->footer(help_text("lease"));
  CLI::App* run =
      add_verb(*lease, options, Verb::lease_run, "run", "hold axes while a command runs, e.g. a shell or a script");
  run->add_option("--axes", options.axes, "numbers or names (default: all axes)")->delimiter(',')->type_name("AXES");
  add_wait(*run, options);
  run->add_flag("--take-over", options.take_over,
                "for administrators: stop the axes and end all other leases over them")
      ->excludes("--wait");
  run->add_option("--at-loss", options.at_loss,
                  "what happens to a running motion when axisctl is killed or loses its connection")
      ->check(CLI::IsMember({"finish", "stop", "stop-and-release"}))
      ->capture_default_str();
  run->add_option("--purpose", options.purpose, "why you hold the axes; others can read it")->type_name("TEXT");
  run->add_option("COMMAND", options.lines, "the command, after --")->required()->type_name("");
  run->positionals_at_end();
  CLI::App* list = add_verb(*lease, options, Verb::lease_list, "list",
                            "show who holds axes, who waits for them, and who must rearm");
  list->add_flag("--follow", options.follow, "show every change, until Ctrl-C");
  CLI::App* hand_over = add_verb(*lease, options, Verb::lease_hand_over, "hand-over",
                                 "give your axes to somebody who waits; type it in the shell that `lease run` opened");
  hand_over->add_option("HOLDER", options.holder, "who waits, as `lease list` shows it, e.g. 'unix bert'")
      ->required()
      ->type_name("");
}

void add_access_verbs(CLI::App& app, Options& options) {
  add_verb(app, options, Verb::who_am_i, "whoami", "show your name and role, as the daemon identifies you");
  CLI::App* token = app.add_subcommand("token", "for administrators: access tokens: create, list, revoke");
  token->require_subcommand(1);
  token->fallthrough();
  token->footer(help_text("token"));
  CLI::App* create = add_verb(*token, options, Verb::token_create, "create",
                              "create a token and print it; to use it, set AXISGATE_TOKEN to it");
  create->add_option("NAME", options.name, "the name: NAME calls as 'token NAME'")->required()->type_name("");
  create->add_option("--role", options.role, "what a caller with this token may do")
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
  app.add_option("--target", target.address,
                 "address of the daemon: path of a Unix socket, or HOST[:PORT] (default: the local daemon)")
      ->envname("AXISGATE_TARGET")
      ->type_name("ADDRESS");
  app.add_flag("--tls", target.tls, "use TLS, for a daemon on another machine ([network] in its configuration)");
  app.add_option("--ca", target.ca,
                 "CA file to verify the daemon's certificate; implies --tls (default: the CAs of this machine)")
      ->envname("AXISGATE_CA")
      ->type_name("FILE");
  CLI::Option* certificate = app.add_option("--certificate", target.certificate,
                                            "your client certificate for TLS; or set AXISGATE_TOKEN to a token")
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

// Sets the headings of `axisctl help`.
void set_groups(CLI::App& app) {
  struct Group {
    const char* heading;
    std::vector<std::string> verbs;
  };
  const Group groups[] = {
      {"Looking", {"devices", "status", "position", "watch", "motions", "history", "audit", "whoami"}},
      {"Moving", {"home", "move", "path", "line", "arc", "scan", "jog", "save", "positions", "go", "forget"}},
      {"Stopping and sharing", {"stop", "cancel", "estop", "withdraw", "rearm", "clear", "lease", "token"}},
      {"Settings",
       {"settings", "speed", "motor", "loop", "divisions", "settle", "sleep", "wake", "display", "beep", "mode",
        "dialect", "reset", "zero", "unzero", "preset", "outputs", "inputs", "trigger"}},
      {"Raw commands, simulator and recordings", {"exec", "commands", "sim", "record", "replay", "support"}},
      {"Mills", {"mill"}},
      {"Help", {"help"}},
  };
  for (const Group& group : groups) {
    for (const std::string& verb : group.verbs) app.get_subcommand(verb)->group(group.heading);
  }
}

bool writes_text_only(Verb verb) { return verb == Verb::record || verb == Verb::replay || verb == Verb::support; }

int list_examples() {
  for (const HelpTopic& topic : help_topics()) print_line(topic.examples);
  return kDone;
}

int show_help(CLI::App& app, const std::string& topic) {
  app.clear();  // otherwise CLI11 would show the help of the verb `help`
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
  print_failure(usage("there is no command and no topic \"" + topic + '"', "axisctl help lists them"));
  return kUsage;
}

int refuse(const CLI::App& app, const CLI::ParseError& error) {
  std::string message = error.what();
  if (app.get_subcommands().empty()) {
    const std::vector<std::string> words = app.remaining();
    message = words.empty() ? "no command was given" : '"' + words.front() + "\" is not a command";
  }
  print_failure(usage(message, "axisctl help lists the commands"));
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
  app.add_option("--device", options.device, "name of the device (default: the only stage, for `mill` the only mill)")
      ->type_name("NAME");
  app.add_option("--request-id", options.request_id,
                 "id of the request; if it comes again with the same id, it does not act again (default: a new one)")
      ->type_name("ID");
  app.add_flag("--json", options.json, "print one JSON object per line");
  app.group("Commands");  // heading that the verbs below a verb inherit
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("REQUIRED", "");
  add_questions(app, options);
  add_motion_verbs(app, options);
  add_position_verbs(app, options);
  add_history_verbs(app, options);
  add_other_verbs(app, options);
  add_lease_verbs(app, options);
  add_access_verbs(app, options);
  add_simulator_verb(app, options);
  add_recording_verbs(app, options);
  add_setting_verbs(app, options);
  add_mill_verbs(app, options);
  CLI::App* help = app.add_subcommand(
      "help", "show this, or explain a command or a topic: units, paths, scans, leases, settings, triggers");
  help->add_option("TOPIC", help_topic)->type_name("");
  help->add_flag("--list-examples", examples)->group("");
  set_groups(app);
  app.footer(help_text("") + kExitCodes);  // set last, otherwise every verb's help would repeat it
  try {
    app.parse(argument_count, arguments);
  } catch (const CLI::CallForHelp& call) {
    return app.exit(call);
  } catch (const CLI::ParseError& error) {
    return refuse(app, error);
  }
  if (const auto other = not_utf8(app, options.verb)) {
    print_failure(*other);
    return other->exit_code;
  }
  if (help->parsed()) return examples ? list_examples() : show_help(app, help_topic);
  if (options.json && writes_text_only(options.verb)) {
    print_failure(usage("this command has no JSON output", "leave out --json"));
    return kUsage;
  }
  Target& target = options.target;
  target.tls = target.tls || !target.ca.empty() || !target.certificate.empty();
  target.address = address(target.address, target.tls);
  options.device = resource(options.device);
  return options;
}

}  // namespace axisgate::axisctl
