// The options of history and audit.
#include <CLI/CLI.hpp>

#include "clients/axisctl/help_topics.h"
#include "clients/axisctl/verb_options.h"

namespace axisgate::axisctl {

void add_history_verbs(CLI::App& app, Options& options) {
  CLI::App* history = add_verb(app, options, Verb::history, "history", "show what has happened, newest first");
  history->add_option("--hours", options.hours, "only the last N hours")->check(CLI::Range(1, 100'000))->type_name("N");
  history->add_option("--who", options.who, "only what this caller did, e.g. 'unix anna'")->type_name("WHO");
  history->add_option("--motion", options.motion, "only the motion with this number")->type_name("NUMBER");
  history->add_option("--limit", options.limit, "at most N entries")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str()
      ->type_name("N");
  CLI::App* audit = app.add_subcommand("audit", "for the journal behind `history`: verify");
  audit->require_subcommand(1);
  audit->fallthrough();
  audit->footer(help_text("audit"));
  CLI::App* verify = add_verb(*audit, options, Verb::audit_verify, "verify",
                              "check that the journal is as it was written, and print its head");
  verify
      ->add_option("--head", options.head,
                   "a head that was printed before: checks that nothing up to there was changed")
      ->type_name("HEAD");
}

}  // namespace axisgate::axisctl
