#include "server/api/mill/job_starts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/api/mill/job_setup.h"
#include "server/api/request/names.h"
#include "server/devices/spooled_jobs.h"

namespace axisgate::api {
namespace {

// Returns the job as it was last published. On the strand, `act` also receives the job as it is then.
Result<jobs::Job> published_job(server::Mill& mill, jobs::JobNumber number) {
  const auto now = mill.newest().get().value;
  const auto found = std::ranges::find(now->jobs, number, &jobs::Job::number);
  if (found != now->jobs.end()) return *found;
  return fail(Reason::not_found, fmt::format("there is no job {} in the queue", number), "`GetMill` lists them");
}

// Returns the problem of a job that was not read because of its published state, although its state allows that now. In
// most cases the state has not changed, and the request is refused because of it.
Problem changed_meanwhile(const jobs::Job& job) {
  return {.reason = Reason::wrong_job_state,
          .message = fmt::format("{} has come to another state while the request waited", text_of(job)),
          .hint = "ask again"};
}

// Returns the first command of the rest, and the duration of the rest.
Result<jobs::JobRest> rest_of(server::Mill& mill, jobs::Job job, const LineToChoose& from) {
  const auto at = server::chosen_rest(mill.spool(), mill.name(), mill.config(), job, from.line, from.column);
  if (!at) return tl::unexpected(at.error());
  job.setup.from = *at;
  const auto prepared =
      server::prepared_job(mill.spool(), mill.name(), mill.config(), job, mill.newest().get().value->measured_pace);
  if (!prepared) return tl::unexpected(prepared.error());
  return jobs::JobRest{*at, (*prepared)->takes(), (*prepared)->run_on()};
}

}  // namespace

// Posts to the mill first, so that the published state is no older than the last answer to the caller.
template <class Read, class Act>
void JobStarts::read_and_act(RequestKind kind, const Call& call, std::string_view name, Read read, Act act,
                             Answer<CurrentJob> answer) const {
  const Result<JobName> found = find_job_name(gateway_, name);
  const auto admitted = pipeline_.admit({kind, call, device_of(found)});
  if (!admitted) return answer(tl::unexpected(admitted.error()));
  const auto on_worker = [this, kind, call, name = std::string(name), read, act, answer, &mill = *admitted->device,
                          number = found->number] {
    const auto came = published_job(mill, number).and_then([&](const jobs::Job& job) { return read(mill, job); });
    acts_.act(
        kind, call, name,
        [came, act](jobs::Machine& controller, const jobs::Job& it, const TurnOf<server::Mill>& turn) {
          return act(controller, it, turn, came);
        },
        answer);
  };
  admitted->device->post([worker = worker_, on_worker, identity = server::identity_of(admitted->caller.who)](
                             jobs::Machine&, TimePoint) { worker->post(identity, on_worker); });
}

void JobStarts::start(const Call& call, std::string_view name, Answer<CurrentJob> answer) const {
  using Prepared = Result<std::shared_ptr<const jobs::PreparedJob>>;
  read_and_act(
      RequestKind::start_job, call, name,
      [](server::Mill& mill, const jobs::Job& job) -> Prepared {
        if (job.state != jobs::JobState::confirmed) return tl::unexpected(changed_meanwhile(job));
        return server::prepared_job(mill.spool(), mill.name(), mill.config(), job,
                                    mill.newest().get().value->measured_pace);
      },
      [](jobs::Machine& controller, const jobs::Job& it, const TurnOf<server::Mill>& turn,
         const Prepared& prepared) -> Result<void> {
        if (const Result<void> can = controller.check_startable(it.number, turn.now); !can) return can;
        if (!prepared) return tl::unexpected(prepared.error());
        const Result<void> fits = check_setup(turn.device, it);
        return fits ? controller.start(it.number, *prepared, turn.context, turn.now) : fits;
      },
      std::move(answer));
}

void JobStarts::choose_rest(const Call& call, std::string_view name, LineToChoose from,
                            Answer<CurrentJob> answer) const {
  const auto can_be_chosen = [](const jobs::Job& job) {
    return jobs::next(job.state, jobs::JobEvent::choose_rest).has_value();
  };
  read_and_act(
      RequestKind::continue_job, call, name,
      [from, can_be_chosen](server::Mill& mill, const jobs::Job& job) -> Result<jobs::JobRest> {
        if (!can_be_chosen(job)) return tl::unexpected(changed_meanwhile(job));
        return rest_of(mill, job, from);
      },
      [can_be_chosen](jobs::Machine& controller, const jobs::Job& it, const TurnOf<server::Mill>& turn,
                      const Result<jobs::JobRest>& rest) -> Result<void> {
        if (can_be_chosen(it) && !rest) return tl::unexpected(rest.error());
        return controller.choose_rest(it.number, rest.value_or(jobs::JobRest()), turn.caller.who, turn.now);
      },
      std::move(answer));
}

}  // namespace axisgate::api
