// Parsing of the command line with CLI11: the options of axisctl, its verbs, and its help. The options of a verb are
// beside its function.
#include "clients/axisctl/arguments/options.h"

#include <CLI/CLI.hpp>
#include <string_view>

#include "clients/axisctl/arguments/addresses.h"
#include "clients/axisctl/arguments/help_topics.h"
#include "clients/axisctl/arguments/option_bytes.h"
#include "clients/axisctl/arguments/verb_options.h"
#include "clients/axisctl/failure.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verb.h"
#include "server/config/default_socket.h"

namespace axisgate::axisctl {
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
void add_verb(CLI::App& app, Options& options, const Verb& verb) {
  const std::size_t space = verb.words.find(' ');
  const bool is_below = space != std::string_view::npos;
  CLI::App& above = is_below ? *app.get_subcommand(std::string(verb.words.substr(0, space))) : app;
  CLI::App& added =
      *above.add_subcommand(std::string(verb.words.substr(is_below ? space + 1 : 0)), std::string(verb.description));
  added.group(is_below ? "Commands" : heading_text(verb.heading));
  added.fallthrough();
  added.footer(help_text(verb.help, verb.examples));
  if (verb.run == nullptr && verb.run_without_daemon == nullptr) {
    added.require_subcommand(1);
    return;
  }
  added.callback([&options, &verb] { options.verb = &verb; });
  if (verb.add_options != nullptr) verb.add_options(added, options);
  if (verb.waits) add_wait(added, options);
}

void add_target(CLI::App& app, client::Target& target) {
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

int list_examples() {
  for (const Verb* verb : verbs()) {
    if (!verb->examples.empty()) print_line(verb->examples);
  }
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
  const std::string text = topic_text(topic);
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
  app.get_formatter()->label("SUBCOMMAND", "COMMAND");
  app.get_formatter()->label("REQUIRED", "");
  for (const Verb* verb : verbs()) add_verb(app, options, *verb);
  CLI::App* help = app.add_subcommand(
      "help", "show this, or explain a command or a topic: units, paths, scans, leases, settings, triggers");
  help->add_option("TOPIC", help_topic)->type_name("");
  help->add_flag("--list-examples", examples)->group("");
  help->group(heading_text(Heading::help));
  app.footer(topic_text("") + kExitCodes);  // set last, otherwise every verb's help would repeat it
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
  if (options.json && !options.verb->has_json) {
    print_failure(usage("this command has no JSON output", "leave out --json"));
    return kUsage;
  }
  client::Target& target = options.target;
  target.tls = target.tls || !target.ca.empty() || !target.certificate.empty();
  target.address = client::address(target.address, target.tls);
  target.token = environment("AXISGATE_TOKEN");
  options.device = resource(options.device);
  return options;
}

}  // namespace axisgate::axisctl
