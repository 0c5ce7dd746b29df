// mill confirm: a person at the mill confirms that all is set up for a job.
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <iostream>
#include <string>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill/job_follower.h"
#include "clients/axisctl/mill/job_number.h"
#include "clients/axisctl/mill/mill_calls.h"
#include "clients/axisctl/mill/mill_text.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

// Throws Failure if no person can be asked.
void check_person(const Options& options) {
  if (options.yes || (::isatty(STDIN_FILENO) == 1 && !options.json)) return;
  throw usage("a person at the mill must confirm the job", "confirm at a terminal, or with --yes once all is set up");
}

v1::Job job_to_confirm(const Session& session) {
  const v1::Mill mill = mill_now(session, mill_to_change(session));
  const std::string name = wanted_job(session, mill);
  if (const v1::Job* const job = find_job(mill, name)) return *job;
  throw Failure{kRefused, "NOT_FOUND", fmt::format("{} has no job {}", last_part(mill.name()), last_part(name)),
                "`axisctl mill queue` lists its jobs"};
}

void ask_person(const v1::Job& job) {
  print_line(setup_question(job));
  std::string answer;
  std::getline(std::cin, answer);
  boost::algorithm::trim(answer);
  boost::algorithm::to_lower(answer);
  if (answer == "yes" || answer == "y") return;
  throw Failure{kFailed, "NOT_CONFIRMED", fmt::format("{} is not confirmed: the answer was not \"yes\"", job_text(job)),
                ""};
}

// Returns the context for the start. A request id from the options belongs to the confirmation, so the start gets
// ID-start.
v1::CallContext context_of_start(const Session& session) {
  v1::CallContext context = session.connection.new_call_context();
  if (!session.options.request_id.empty()) context.set_request_id(session.options.request_id + "-start");
  return context;
}

// Starts the confirmed job. If the start is refused, the hint says how to start again, without a second confirmation.
int start_confirmed(const Session& session, const v1::Job& job) {
  try {
    return start_job(session, context_of_start(session), job.name());
  } catch (Failure& failure) {
    const std::string next = fmt::format("the job is confirmed: `axisctl mill start {}`", last_part(job.name()));
    failure.hint = failure.hint.empty() ? next : fmt::format("{}; {}", failure.hint, next);
    throw;
  }
}

int mill_confirm(const Session& session) {
  const Options& options = session.options;
  check_person(options);
  const v1::Job job = job_to_confirm(session);
  if (!options.json) {
    for (const std::string& line : setup_lines(job)) print_line(line);
  }
  if (!options.yes) ask_person(job);
  v1::ConfirmJobRequest request;
  *request.mutable_context() = session.connection.new_call_context();
  request.set_job(job.name());
  *request.mutable_seen() = job.setup();
  const v1::ConfirmJobResponse response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::ConfirmJob, request, kQuestionLimit);
  options.json ? print_json(response) : print_line(confirmed_text(response.job()));
  return options.job.start ? start_confirmed(session, job) : kDone;
}

void mill_confirm_options(CLI::App& verb, Options& options) {
  add_job_number(verb, options, "its number (default: the first that waits)");
  verb.add_flag("--yes", options.yes, "all is set up: do not ask");
  CLI::Option* starts = verb.add_flag("--start", options.job.start, "start the job, too");
  verb.add_flag("--follow", options.follow, "show the job until it has ended")->needs(starts);
}

constexpr Verb kMillConfirmVerbs[] = {
    {.words = "mill confirm",
     .description = "at the mill: say that all is set up for a job",
     .add_options = mill_confirm_options,
     .run = mill_confirm},
};

}  // namespace

std::span<const Verb> mill_confirm_verbs() { return kMillConfirmVerbs; }

}  // namespace axisgate::axisctl
