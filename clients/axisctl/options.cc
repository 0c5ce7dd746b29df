// Parsing of the command line. CLI11 takes eight seconds to compile, so only this file, option_bytes.cc,
// setting_options.cc, history_options.cc and mill_options.cc include it.
#include "clients/axisctl/options.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <utility>

#include "clients/axisctl/addresses.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/help_topics.h"
#include "clients/axisctl/option_bytes.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verb.h"
#include "clients/axisctl/verb_options.h"

namespace axisgate::axisctl {

CLI::App* add_verb(CLI::App& app, Options& options, OldVerb verb, const char* name, const char* description) {
  CLI::App* added = app.add_subcommand(name, description);
  added->fallthrough();
  added->footer(help_text(name));
  added->callback([&options, verb] { options.old_verb = verb; });
  return added;
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

const char* heading_text(Heading heading) {
  switch (heading) {
    case Heading::looking:
      return "Looking";
    case Heading::moving:
      return "Moving";
    case Heading::stopping:
      return "Stopping and sharing";
    case Heading::raw:
      return "Raw commands, simulator and recordings";
    case Heading::settings:
      return "Settings";
    case Heading::mills:
      return "Mills";
    case Heading::help:
      return "Help";
  }
  return "";
}

// Adds a verb, whose help ends with its examples. `options` must outlive the parsing.
void add_row(CLI::App& app, Options& options, const Verb& verb) {
  const std::size_t space = verb.words.find(' ');
  const bool is_below = space != std::string_view::npos;
  CLI::App& above = is_below ? *app.get_subcommand(std::string(verb.words.substr(0, space))) : app;
  CLI::App& added =
      *above.add_subcommand(std::string(verb.words.substr(is_below ? space + 1 : 0)), std::string(verb.description));
  added.group(is_below ? "Commands" : heading_text(verb.heading));
  added.fallthrough();
  added.footer(text_of(verb.help, verb.examples));
  if (verb.run == nullptr && verb.run_without_daemon == nullptr) {
    added.require_subcommand(1);
    return;
  }
  added.callback([&options, &verb] { options.verb = &verb; });
  if (verb.add_options != nullptr) verb.add_options(added, options);
  if (verb.waits) add_wait(added, options);
}

void add_other_verbs(CLI::App& app, Options& options) {
  add_verb(app, options, OldVerb::rearm, "rearm",
           "after a stop by somebody else: allow your motions again; moves nothing");
  CLI::App* watch = add_verb(app, options, OldVerb::watch, "watch",
                             "print every event (motions, stops, errors), each with its revision: its number");
  watch->add_option("--from", options.from_revision, "the first event wanted (default: the next one)")
      ->type_name("REVISION");
}

void add_simulator_verb(CLI::App& app, Options& options) {
  CLI::App* sim =
      add_verb(app, options, OldVerb::sim, "sim", "simulator only: press buttons, switch inputs, trip limits, unplug");
  sim->add_option("COMMAND", options.lines, "`help` lists them")->required()->type_name("");
}

void add_recording_verbs(CLI::App& app, Options& options) {
  CLI::App* record = add_verb(app, options, OldVerb::record, "record",
                              "print the serial traffic: the last minutes, then all that follows until Ctrl-C");
  record->add_option("--output", options.output, "the file to write (default: the standard output)")->type_name("FILE");
  CLI::Option* no_follow = record->add_flag("--no-follow", options.no_follow, "only the last minutes");
  CLI::Option* only_new = record->add_flag("--new", options.only_new, "without the last minutes");
  CLI::Option* seconds = record->add_option("--seconds", options.seconds, "end after this time");
  seconds->check(CLI::Range(1, 1'000'000))->type_name("S");
  no_follow->excludes(only_new)->excludes(seconds);

  CLI::App* replay = add_verb(app, options, OldVerb::replay, "replay",
                              "for developers: run recorded traffic through this version; moves nothing");
  replay->add_option("FILE", options.file, "a recording or a support report; - reads the standard input")
      ->required()
      ->type_name("");

  CLI::App* support = add_verb(app, options, OldVerb::support, "support",
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
      add_verb(*lease, options, OldVerb::lease_run, "run", "hold axes while a command runs, e.g. a shell or a script");
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
  CLI::App* list = add_verb(*lease, options, OldVerb::lease_list, "list",
                            "show who holds axes, who waits for them, and who must rearm");
  list->add_flag("--follow", options.follow, "show every change, until Ctrl-C");
  CLI::App* hand_over = add_verb(*lease, options, OldVerb::lease_hand_over, "hand-over",
                                 "give your axes to somebody who waits; type it in the shell that `lease run` opened");
  hand_over->add_option("HOLDER", options.holder, "who waits, as `lease list` shows it, e.g. 'unix bert'")
      ->required()
      ->type_name("");
}

void add_access_verbs(CLI::App& app, Options& options) {
  add_verb(app, options, OldVerb::who_am_i, "whoami", "show your name and role, as the daemon identifies you");
  CLI::App* token = app.add_subcommand("token", "for administrators: access tokens: create, list, revoke");
  token->require_subcommand(1);
  token->fallthrough();
  token->footer(help_text("token"));
  CLI::App* create = add_verb(*token, options, OldVerb::token_create, "create",
                              "create a token and print it; to use it, set AXISGATE_TOKEN to it");
  create->add_option("NAME", options.name, "the name: NAME calls as 'token NAME'")->required()->type_name("");
  create->add_option("--role", options.role, "what a caller with this token may do")
      ->check(CLI::IsMember({"observer", "operator", "admin"}))
      ->capture_default_str();
  create->add_option("--days", options.days, "days until it expires")
      ->check(CLI::Range(1, 3650))
      ->capture_default_str()
      ->type_name("DAYS");
  add_verb(*token, options, OldVerb::token_list, "list", "show the tokens, with role and expiry");
  CLI::App* revoke =
      add_verb(*token, options, OldVerb::token_revoke, "revoke", "refuse all further calls with this token");
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

bool writes_text_only(OldVerb verb) {
  return verb == OldVerb::record || verb == OldVerb::replay || verb == OldVerb::support;
}

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
  for (const Verb* verb : verbs()) add_row(app, options, *verb);
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("REQUIRED", "");
  add_history_verbs(app, options);
  add_other_verbs(app, options);
  add_lease_verbs(app, options);
  add_access_verbs(app, options);
  add_simulator_verb(app, options);
  add_recording_verbs(app, options);
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
  if (const auto other = not_utf8(app)) {
    print_failure(*other);
    return other->exit_code;
  }
  if (help->parsed()) return examples ? list_examples() : show_help(app, help_topic);
  if (options.json && (options.verb != nullptr ? !options.verb->has_json : writes_text_only(options.old_verb))) {
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
