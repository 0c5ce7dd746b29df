// mill again, and mill send --rest-of: queue an ended job, or the rest of it, as a new job.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill/job_places.h"
#include "clients/axisctl/mill/mill_calls.h"
#include "clients/axisctl/mill/mill_text.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

v1::RepeatJobRequest repeat_request(const Session& session, std::uint64_t number) {
  v1::RepeatJobRequest request;
  request.set_job(fmt::format("{}/jobs/{}", mill_to_change(session), number));
  *request.mutable_context() = session.connection.new_call_context();
  for (const std::string& name : session.options.job.accepted) request.add_accepted_warnings(name);
  return request;
}

int repeat(const Session& session, const v1::RepeatJobRequest& request) {
  const v1::RepeatJobResponse response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::RepeatJob, request, kStartLimit);
  session.options.json ? print_json(response) : print_line(state_text(response.job()));
  return kDone;
}

int mill_again(const Session& session) {
  return repeat(session, repeat_request(session, session.options.job.number.value()));
}

void mill_again_options(CLI::App& verb, Options& options) {
  verb.add_option("JOB", options.job.number, "its number")->required()->type_name("");
  verb.add_option("--accept", options.job.accepted,
                  "warnings that the check finds now, beside those that were accepted for it")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("NAME");
}

constexpr Verb kMillRepeatVerbs[] = {
    {.words = "mill again",
     .description = "queue a job that has ended once more, as a new job",
     .add_options = mill_again_options,
     .run = mill_again},
};

}  // namespace

int mill_send_rest(const Session& session) {
  const JobOptions& job = session.options.job;
  const bool is_as_before = job.files.empty() && job.tools.empty() && job.origin.empty() && job.title.empty() &&
                            job.streaming.empty() && job.made_for.empty() && !job.stock && !job.continues;
  if (!is_as_before) {
    throw usage("the rest of a job has the file, the tools, the origin and all else of that job",
                "name only --from, and --accept, beside --rest-of");
  }
  v1::RepeatJobRequest request = repeat_request(session, *job.rest_of);
  request.set_rest(true);
  // Without a line the daemon refuses, and its message names the place where the executed part ends.
  if (job.from) {
    const jobs::Place from = job_place(*job.from);
    request.set_line(static_cast<std::int64_t>(from.line));
    request.set_column(static_cast<std::int64_t>(from.column));
  }
  return repeat(session, request);
}

std::span<const Verb> mill_repeat_verbs() { return kMillRepeatVerbs; }

}  // namespace axisgate::axisctl
