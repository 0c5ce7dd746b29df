// mill start, watch, pause, resume, abort, cancel, clear, first, done: the verbs that make a single request to a mill.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/mill/job_follower.h"
#include "clients/axisctl/mill/job_number.h"
#include "clients/axisctl/mill/job_places.h"
#include "clients/axisctl/mill/mill_calls.h"
#include "clients/axisctl/mill/mill_text.h"
#include "clients/axisctl/print.h"
#include "clients/axisctl/verbs.h"

namespace axisgate::axisctl {
namespace {

template <class Request>
Request mill_request(const Session& session) {
  Request request;
  request.set_device(mill_to_change(session));
  *request.mutable_context() = session.connection.new_call_context();
  return request;
}

// Returns a request for the job whose number was typed.
template <class Request>
Request job_request(const Session& session) {
  Request request;
  request.set_job(fmt::format("{}/jobs/{}", mill_to_change(session), session.options.job.number.value()));
  *request.mutable_context() = session.connection.new_call_context();
  return request;
}

int report_answer(const Session& session, const google::protobuf::Message& response, const std::string& text) {
  session.options.json ? print_json(response) : print_line(text);
  return kDone;
}

int choose_rest(const Session& session) {
  auto request = job_request<v1::ContinueJobRequest>(session);
  // Without a line the daemon refuses, and its message names the place where the sent part ends.
  if (session.options.job.from) {
    const jobs::Place from = job_place(*session.options.job.from);
    request.set_line(static_cast<std::int64_t>(from.line));
    request.set_column(static_cast<std::int64_t>(from.column));
  }
  const auto response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::ContinueJob, request, kStartLimit);
  return report_answer(session, response, rest_text(response.job()));
}

int mill_start(const Session& session) {
  const std::string job = wanted_job(session, mill_now(session, mill_to_change(session)));
  return start_job(session, session.connection.new_call_context(), job);
}

int mill_watch(const Session& session) { return JobFollower(session, "").follow(); }

int mill_pause(const Session& session) {
  auto request = mill_request<v1::PauseJobRequest>(session);
  request.set_raise_tool(session.options.job.raise);
  const auto response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::PauseJob, request, kQuestionLimit);
  return report_answer(session, response, paused_text(response.running()));
}

int mill_resume(const Session& session) {
  if (session.options.job.number) return choose_rest(session);
  const auto request = mill_request<v1::ResumeJobRequest>(session);
  const auto response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::ResumeJob, request, kQuestionLimit);
  return report_answer(session, response,
                       fmt::format("job {} is resumed; {}", last_part(response.running().job()),
                                   run_on_text(response.running().run_on())));
}

// Aborts without delay: no other call is made first if the mill is named.
int mill_abort(const Session& session) {
  v1::AbortJobRequest request;
  *request.mutable_context() = new_stop_context();
  request.set_device(chosen_mill(session));
  const auto response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::AbortJob, request, kStopLimit);
  return report_answer(session, response, aborted_text(response));
}

int mill_cancel(const Session& session) {
  const auto request = job_request<v1::CancelJobRequest>(session);
  const auto response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::CancelJob, request, kQuestionLimit);
  return report_answer(session, response, fmt::format("job {} is CANCELLED", last_part(request.job())));
}

int mill_clear(const Session& session) {
  auto request = mill_request<v1::CancelJobsRequest>(session);
  request.set_owner(session.options.who);
  const auto response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::CancelJobs, request, kQuestionLimit);
  std::vector<std::string> numbers;
  for (const std::string& job : response.jobs()) numbers.emplace_back(last_part(job));
  const bool one = numbers.size() == 1;
  return report_answer(session, response,
                       fmt::format("{} {} of {} {} CANCELLED", one ? "job" : "jobs", fmt::join(numbers, ", "),
                                   on_one_line(request.owner()), one ? "is" : "are"));
}

int mill_first(const Session& session) {
  const auto request = job_request<v1::MoveJobRequest>(session);
  const auto response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::MoveJob, request, kQuestionLimit);
  return report_answer(session, response,
                       fmt::format("{} is as far forward as you may move it; `axisctl mill queue` shows the order",
                                   job_text(response.job())));
}

int mill_done(const Session& session) {
  v1::ReportJobDoneRequest request;
  request.set_job(fed_job(session, mill_now(session, mill_to_change(session))));
  *request.mutable_context() = session.connection.new_call_context();
  const auto response =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::ReportJobDone, request, kQuestionLimit);
  return report_answer(session, response, fmt::format("job {} is DONE", last_part(request.job())));
}

void mill_start_options(CLI::App& verb, Options& options) {
  add_job_number(verb, options, "its number (default: the first that waits)");
  verb.add_flag("--follow", options.follow, "show the job until it has ended");
}

void mill_pause_options(CLI::App& verb, Options& options) {
  verb.add_flag("--raise", options.job.raise, "raise the tool after the last sent byte, and stop the spindle");
}

void mill_resume_options(CLI::App& verb, Options& options) {
  CLI::Option* job = add_job_number(verb, options, "the number of a job that is PAUSED or PAUSED_UNKNOWN");
  verb.add_option("--from", options.job.from,
                  "the line of its file, or line and column, with whose first command it continues")
      ->needs(job)
      ->type_name("LINE[:COLUMN]");
}

void mill_clear_options(CLI::App& verb, Options& options) {
  verb.add_option("WHO", options.who, "their owner as `mill queue` shows it, e.g. 'unix anna'")
      ->required()
      ->type_name("");
}

void add_required_job(CLI::App& verb, Options& options) { add_job_number(verb, options, "its number")->required(); }

void mill_done_options(CLI::App& verb, Options& options) {
  add_job_number(verb, options, "its number (default: the one that is FED)");
}

constexpr Verb kMillJobVerbs[] = {
    {.words = "mill start",
     .description = "start a job that is confirmed",
     .add_options = mill_start_options,
     .run = mill_start},
    {.words = "mill watch", .description = "show the job that runs until it has ended", .run = mill_watch},
    {.words = "mill pause",
     .description = "send no more of the job; what was sent runs on",
     .add_options = mill_pause_options,
     .run = mill_pause},
    {.words = "mill resume",
     .description = "send the rest of the job that is paused; with JOB, choose where that one continues",
     .add_options = mill_resume_options,
     .run = mill_resume},
    {.words = "mill abort", .description = "end the job that runs; look at the mill afterwards", .run = mill_abort},
    {.words = "mill cancel",
     .description = "take a job out of the queue",
     .add_options = add_required_job,
     .run = mill_cancel},
    {.words = "mill clear",
     .description = "for administrators: take a caller's waiting jobs out of the queue",
     .add_options = mill_clear_options,
     .run = mill_clear},
    {.words = "mill first",
     .description = "move a job to the front of the queue",
     .add_options = add_required_job,
     .run = mill_first},
    {.words = "mill done",
     .description = "say that the workpiece of a job was seen",
     .add_options = mill_done_options,
     .run = mill_done},
};

}  // namespace

std::span<const Verb> mill_job_verbs() { return kMillJobVerbs; }

}  // namespace axisgate::axisctl
