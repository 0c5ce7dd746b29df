#include "clients/axisctl/mill/job_follower.h"

#include <fmt/format.h>

#include "clients/axisctl/failure.h"
#include "clients/axisctl/interrupt.h"
#include "clients/axisctl/mill/mill_calls.h"
#include "clients/axisctl/mill/mill_text.h"
#include "clients/axisctl/print.h"

namespace axisgate::axisctl {
namespace {

// Reports whether a started job has left RUNNING. Earlier states count as not yet run, because the newest known state
// may precede the start.
bool has_run(v1::JobState state) { return state > v1::JOB_STATE_RUNNING; }

std::string fed_text(const v1::Job& job) {
  return fmt::format(
      "{} FED: all was sent, and the slowest mill has executed it by now; look at the workpiece, then "
      "`axisctl mill done {}`",
      job_text(job), last_part(job.name()));
}

std::string tool_change_text(const v1::Job& job) {
  return fmt::format(
      "{} TOOL_CHANGE: part {} of {} was sent, and the slowest mill has executed it by now; put in the tool {}, set "
      "Z0, then `axisctl mill confirm {} --start`",
      job_text(job), job.part() - 1, job.parts_size(), on_one_line(job.setup().tool()), last_part(job.name()));
}

// Text for a job that waits for a person, with nothing wrong: FED, TOOL_CHANGE or PAUSED. Empty for other states.
std::string halt_text(const v1::Job& job) {
  if (job.state() == v1::JOB_STATE_FED) return fed_text(job);
  if (job.state() == v1::JOB_STATE_TOOL_CHANGE) return tool_change_text(job);
  return job.state() == v1::JOB_STATE_PAUSED ? rest_text(job) : "";
}

Failure unknown_sent(const v1::Job& job) {
  return {
      kFailed, "PAUSED_UNKNOWN",
      fmt::format("{}: the line broke, or the daemon was killed; the mill was sent {} to {} of {} bytes", job_text(job),
                  job.sent_least(), job.sent_most(), job.bytes()),
      fmt::format(
          "look at the mill; `axisctl mill resume {0}` lets the job continue from a line that you choose, and `axisctl "
          "mill cancel {0}` takes it out of the queue",
          last_part(job.name()))};
}

}  // namespace

int start_job(const Session& session, const v1::CallContext& context, const std::string& job) {
  v1::StartJobRequest request;
  *request.mutable_context() = context;
  request.set_job(job);
  const v1::StartJobResponse started =
      session.connection.call(session.connection.mills, &v1::MillService::Stub::StartJob, request, kStartLimit);
  if (session.options.json) {
    print_json(started);
  } else {
    print_line(state_text(started.job()));
  }
  return session.options.follow ? JobFollower(session, job).follow() : kDone;
}

JobFollower::JobFollower(const Session& session, const std::string& job)
    : session_(session), was_started_(!job.empty()) {
  job_.set_name(job);
}

int JobFollower::follow() {
  v1::WatchMillRequest request;
  request.set_device(chosen_mill(session_));
  grpc::ClientContext context;
  const auto reader = session_.connection.mills->WatchMill(&context, request);
  v1::WatchMillResponse response;
  bool ended = false;
  while (!ended && reader->Read(&response)) ended = show(response.mill());
  if (ended) context.TryCancel();
  while (reader->Read(&response)) continue;
  const grpc::Status status = reader->Finish();
  display_.finish();
  if (ended) return report_end();
  if (job_.name().empty()) session_.connection.check(status);
  throw Failure{kFailed, "OUTCOME_UNKNOWN",
                fmt::format("the daemon reports no more of job {}: {}", last_part(job_.name()), status.error_message()),
                "the job may still run: look at the mill, and check with `axisctl mill queue`"};
}

bool JobFollower::show(const v1::Mill& mill) {
  if (session_.options.json) print_json(mill);
  if (job_.name().empty() && mill.has_running()) job_.set_name(mill.running().job());
  if (job_.name().empty()) return show_waiting(mill);
  const v1::Job* const job = find_job(mill, job_.name());
  gone_ = job == nullptr;
  if (gone_ && mill.ended().name() == job_.name()) job_ = mill.ended();
  if (gone_) return true;
  job_ = *job;
  if (mill.running().job() == job_.name()) show_progress(mill.running());
  return has_run(job_.state());
}

// Shows the job that waits. Reports whether the queue is empty, so that there is nothing to wait for.
bool JobFollower::show_waiting(const v1::Mill& mill) {
  nothing_to_come_ = mill.jobs().empty();
  const std::string text = waiting_text(mill);
  if (text != said_ && !session_.options.json) display_.fact(text);
  said_ = text;
  return nothing_to_come_;
}

void JobFollower::show_progress(const v1::RunningJob& running) {
  const bool first = running_.job().empty();
  const bool newly_busy = running.busy() && !running_.busy();
  running_ = running;
  if (first) say_on_interrupt("the job continues; to end it: axisctl mill abort");
  if (session_.options.json) return;
  if (first && !was_started_) display_.fact(state_text(job_));
  if (newly_busy) display_.fact(kBusyText);
  display_.in_place(progress_text(job_, running));
}

int JobFollower::report_end() const {
  if (nothing_to_come_) return kDone;
  if (const std::string text = gone_ ? "" : halt_text(job_); !text.empty()) {
    if (!session_.options.json) print_line(text);
    return kDone;
  }
  if (!gone_ && job_.state() == v1::JOB_STATE_PAUSED_UNKNOWN) throw unknown_sent(job_);
  if (job_.state() == v1::JOB_STATE_DONE) {
    if (!session_.options.json) print_line(fmt::format("{} DONE: somebody has seen its workpiece", job_text(job_)));
    return kDone;
  }
  if (job_.state() == v1::JOB_STATE_ABORTED || (gone_ && running_.sending() == v1::SENDING_STATE_ABORTING)) {
    const bool known = job_.has_executed();
    throw Failure{kFailed, "ABORTED",
                  fmt::format("the abort of {} was sent; whether the mill has followed it is not known{}",
                              job_text(job_), known ? "; " + executed_text(job_) : ""),
                  known ? "look at the mill; " + remains_text(job_) : "look at the mill"};
  }
  throw Failure{kFailed, "OUTCOME_UNKNOWN",
                fmt::format("job {} has left the queue: it was aborted, or somebody has reported its end",
                            last_part(job_.name())),
                "look at the mill"};
}

}  // namespace axisgate::axisctl
