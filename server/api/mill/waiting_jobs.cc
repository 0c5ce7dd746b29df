#include "server/api/mill/waiting_jobs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <utility>

#include "server/access/access.h"
#include "server/api/mill/job_setup.h"
#include "server/api/request/names.h"
#include "server/journal/answers.h"

namespace axisgate::api {
namespace {

using MillTurn = TurnOf<server::Mill>;

bool is_admin(const MillTurn& turn) { return turn.caller.role == server::Role::admin; }

// `act` is a verb for the message: "cancel".
Result<void> check_owner(const MillTurn& turn, const jobs::Job& job, std::string_view act) {
  if (is_admin(turn) || server::is_certainly(turn.caller.who, job.owner)) return {};
  return fail(Reason::not_allowed, fmt::format("{} is not yours", text_of(job)),
              fmt::format("its owner or an administrator can {} it", act));
}

// Returns the waiting jobs of the caller, or of all callers that the queue counts as the same one.
Result<std::vector<jobs::JobNumber>> waiting_jobs_of(const std::string& who, const MillTurn& turn) {
  std::vector<jobs::JobNumber> found;
  for (const jobs::Job& job : turn.controller.jobs()) {
    const bool is_theirs = server::queued_as(job.owner) == server::queued_as(who);
    if (is_theirs && waits_to_begin(job)) found.push_back(job.number);
  }
  if (!found.empty()) return found;
  return fail(Reason::not_found, fmt::format("no job of {} waits for {}", who, turn.device.name()),
              "`GetMill` shows whose jobs wait; one that was begun is taken out by `CancelJob`");
}

}  // namespace

void WaitingJobs::confirm(const Call& call, std::string_view job, const jobs::JobSetup& seen,
                          Answer<CurrentJob> answer) const {
  acts_.act(
      RequestKind::confirm_job, call, job,
      [seen](jobs::Machine& mill, const jobs::Job& it, const MillTurn& turn) -> Result<void> {
        if (const Result<void> there = check_at_station(turn.device, turn.caller.who); !there) return there;
        const Result<void> fits = check_setup(turn.device, it);
        return fits ? mill.confirm(it.number, seen, turn.caller.who, turn.now) : fits;
      },
      std::move(answer));
}

void WaitingJobs::done(const Call& call, std::string_view job, Answer<CurrentJob> answer) const {
  acts_.act(
      RequestKind::report_job_done, call, job,
      [](jobs::Machine& mill, const jobs::Job& it, const MillTurn& turn) {
        return mill.done(it.number, turn.caller.who, turn.now);
      },
      std::move(answer));
}

void WaitingJobs::cancel(const Call& call, std::string_view job, Answer<CurrentJob> answer) const {
  acts_.act(
      RequestKind::cancel_job, call, job,
      [](jobs::Machine& mill, const jobs::Job& it, const MillTurn& turn) -> Result<void> {
        const Result<void> may = check_owner(turn, it, "cancel");
        return may ? mill.cancel(it.number, turn.caller.who, turn.now) : may;
      },
      std::move(answer));
}

// The journal's entry for the request names no person; the entries of the jobs say who cancelled each.
void WaitingJobs::cancel_all(const Call& call, std::string_view device, std::string who,
                             Answer<CancelledJobs> answer) const {
  std::optional<Problem> fault;
  if (who.empty()) {
    fault = Problem{.reason = Reason::invalid_request,
                    .message = "it is not said whose jobs",
                    .hint = "set `owner` to the name of their owner"};
  }
  pipeline_.act(
      {RequestKind::cancel_jobs, call, find_mill(gateway_, device), fault},
      [who](const MillTurn& turn) -> Result<std::string> {
        if (const Result<void> in_time = check_in_time(turn); !in_time) return tl::unexpected(in_time.error());
        return waiting_jobs_of(who, turn).map([](const std::vector<jobs::JobNumber>& jobs) {
          return fmt::format("{} {}", api::name(RequestKind::cancel_jobs), fmt::join(jobs, ", "));
        });
      },
      [who, answer](const MillTurn& turn, const MutationPtr& mutation) {
        const std::vector<jobs::JobNumber> jobs = waiting_jobs_of(who, turn).value();
        for (const jobs::JobNumber job : jobs) (void)turn.controller.cancel(job, turn.caller.who, turn.now);
        mutation->acted(server::journal::answer_of(jobs));
        turn.device.when_kept([answer, cancelled = CancelledJobs{&turn.device, jobs}] { answer(cancelled); });
      },
      [answer](const Problem& problem) { answer(tl::unexpected(problem)); },
      [answer](const server::Mill& mill, const Result<Known>& known) {
        repeat_done(known, [&](const Result<void>& done) {
          if (!done) return answer(tl::unexpected(done.error()));
          answer(CancelledJobs{&mill, server::journal::jobs_in(known->answer)});
        });
      });
}

void WaitingJobs::move_first(const Call& call, std::string_view job, Answer<CurrentJob> answer) const {
  acts_.act(
      RequestKind::move_job, call, job,
      [](jobs::Machine& mill, const jobs::Job& it, const MillTurn& turn) -> Result<void> {
        const Result<void> may = check_owner(turn, it, "move");
        if (!may) return may;
        return mill.move_first(it.number, is_admin(turn) ? jobs::Overtaken::all : jobs::Overtaken::of_its_owner,
                               turn.caller.who, turn.now);
      },
      std::move(answer));
}

}  // namespace axisgate::api
