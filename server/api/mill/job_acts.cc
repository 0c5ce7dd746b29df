#include "server/api/mill/job_acts.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

#include "server/api/request/names.h"
#include "server/journal/answers.h"

namespace axisgate::api {
namespace {

using server::Mill;
using MillTurn = TurnOf<Mill>;

// Answers a repeated request with the job as it is now, without acting. If the job has left the queue meanwhile and
// `then` is a final state, the answer is a job in that state.
void repeat_job(Mill& mill, const Result<Known>& known, jobs::JobNumber number, jobs::JobState then,
                const Answer<CurrentJob>& answer) {
  repeat_done(known, [&](const Result<void>& done) {
    if (!done) return answer(tl::unexpected(done.error()));
    mill.post([&mill, number, then, answer](jobs::Machine& controller, TimePoint now) {
      const Result<jobs::Job> job = find_job(controller, number);
      if (!job && !jobs::is_end(then)) return answer(tl::unexpected(job.error()));
      jobs::Job ended;
      ended.number = number;
      ended.state = then;
      CurrentJob current{&mill, job.value_or(ended), server::moment_of(now)};
      const auto running = controller.running(now);
      if (running && running->number == number) current.run_on = running->run_on;
      answer(std::move(current));
    });
  });
}

// Returns the state of a job after a request of this kind.
jobs::JobState outcome_of(RequestKind kind) {
  if (kind == RequestKind::cancel_job) return jobs::JobState::cancelled;
  if (kind == RequestKind::continue_job) return jobs::JobState::paused;
  return kind == RequestKind::report_job_done ? jobs::JobState::done : jobs::JobState::running;
}

}  // namespace

Result<jobs::Job> find_job(const jobs::Machine& mill, jobs::JobNumber number) {
  const auto found = std::ranges::find(mill.jobs(), number, &jobs::Job::number);
  if (found != mill.jobs().end()) return *found;
  return fail(Reason::not_found, fmt::format("there is no job {} in the queue", number),
              "`GetMill` lists them; `ListHistory` has those that have ended");
}

Result<void> check_in_time(const MillTurn& turn) {
  if (turn.now <= turn.context.not_after) return {};
  return fail(Reason::deadline_passed, "the request reached the mill after its not_after",
              "ask again, with a later not_after");
}

void JobActs::act(RequestKind kind, const Call& call, std::string_view name, Act act, Answer<CurrentJob> answer) const {
  const Result<JobName> found = find_job_name(gateway_, name);
  const jobs::JobNumber number = found ? found->number : 0;
  pipeline_.act(
      {kind, call, device_of(found)},
      [kind, number](const MillTurn& turn) -> Result<std::string> {
        if (const Result<void> in_time = check_in_time(turn); !in_time) return tl::unexpected(in_time.error());
        const Result<jobs::Job> job = find_job(turn.controller, number);
        if (!job) return tl::unexpected(job.error());
        return fmt::format("{} {}", api::name(kind), number);
      },
      [number, act, answer](const MillTurn& turn, const MutationPtr& mutation) {
        const Result<jobs::Job> job = find_job(turn.controller, number);
        const Result<void> done = job ? act(turn.controller, *job, turn) : tl::unexpected(job.error());
        if (!done) {
          mutation->failed(done.error());
          return answer(tl::unexpected(done.error()));
        }
        mutation->acted(server::journal::answer_done());
        turn.device.when_kept([answer, now = current(turn, *job)] { answer(now); });
      },
      [answer](const Problem& problem) { answer(tl::unexpected(problem)); },
      [number, then = outcome_of(kind), answer](Mill& mill, const Result<Known>& known) {
        repeat_job(mill, known, number, then, answer);
      });
}

}  // namespace axisgate::api
