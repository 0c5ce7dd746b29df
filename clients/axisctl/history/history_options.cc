// Options of history, motions, cancel and audit.
#include <CLI/CLI.hpp>

#include "clients/axisctl/help_topics.h"
#include "clients/axisctl/verb_options.h"

namespace axisgate::axisctl {
namespace {

void add_history(CLI::App& app, Options& options) {
  CLI::App* history = add_verb(app, options, OldVerb::history, "history", "show what has happened, newest first");
  CLI::Option* hours = history->add_option("--hours", options.hours, "only the last N hours");
  hours->check(CLI::Range(1, 100'000))->type_name("N");
  CLI::Option* who = history->add_option("--who", options.who, "only what this caller did, e.g. 'unix anna'");
  CLI::Option* motion = history->add_option("--motion", options.motion,
                                            "only the motion with this number, oldest first, and how it ended");
  CLI::Option* axis = history->add_option("--axis", options.axis, "only what names this axis: a number or a name");
  CLI::Option* outcome = history->add_option("--outcome", options.outcome, "only motions that ended so")
                             ->check(CLI::IsMember({"succeeded", "stopped", "failed", "unknown"}));
  CLI::Option* text = history->add_option("--text", options.text, "only entries with this text in their details");
  CLI::Option* limit = history->add_option("--limit", options.limit, "at most N entries");
  limit->check(CLI::Range(1, 1'000'000))->capture_default_str();
  CLI::Option* follow =
      history->add_flag("--follow", options.follow, "oldest first, then each new entry, until Ctrl-C");
  CLI::Option* csv = history->add_flag("--csv", options.csv, "as a table for other programs, times in UTC");
  CLI::Option* night = history->add_flag("--night", options.night,
                                         "who moved what, and what went wrong, since 18:00 yesterday or in --hours N");
  who->type_name("WHO");
  motion->type_name("NUMBER");
  axis->type_name("AXIS");
  outcome->type_name("OUTCOME");
  text->type_name("TEXT");
  limit->type_name("N");
  for (CLI::Option* other : {who, motion, axis, outcome, text, limit, follow, csv}) night->excludes(other);
  // These options would hide the entry with the motion's outcome.
  for (CLI::Option* other : {hours, who, axis, outcome, text, limit, follow}) motion->excludes(other);
  csv->excludes(app.get_option("--json"));
}

}  // namespace

void add_history_verbs(CLI::App& app, Options& options) {
  add_history(app, options);
  CLI::App* audit = app.add_subcommand("audit", "for the journal of `history`: verify, erase");
  audit->require_subcommand(1);
  audit->fallthrough();
  audit->footer(help_text("audit"));
  CLI::App* verify = add_verb(*audit, options, OldVerb::audit_verify, "verify",
                              "check that the journal is as it was written, and print its head");
  verify
      ->add_option("--head", options.head,
                   "a head that was printed before: checks that nothing up to there was changed")
      ->type_name("HEAD");
  CLI::App* erase = add_verb(*audit, options, OldVerb::audit_erase, "erase",
                             "for administrators: erase the name of a caller from the journal, for ever");
  erase->add_option("NAME", options.who, "as `history` shows it, e.g. 'unix anna'")->required()->type_name("");
  erase->add_flag("--yes", options.yes, "do it: nothing brings the name back");
}

}  // namespace axisgate::axisctl
