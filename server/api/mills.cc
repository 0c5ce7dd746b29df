#include "server/api/mills.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/api/audit.h"
#include "server/api/job_setup.h"
#include "server/api/names.h"
#include "server/devices/spooled_jobs.h"

namespace axisgate::api {
namespace {

using server::Mill;
using MillTurn = TurnOf<Mill>;

// The newest state.
class MillWatch final : public Subscription<MillState> {
 public:
  MillWatch(Mill& mill, Streams::Place place) : Subscription(std::move(place)), mill_(mill) {}

 private:
  void begin() override {
    woken_by(mill_.newest());
    wake();
  }

  Reading read() override {
    const auto newest = mill_.newest().get();
    if (newest.version == taken_) return Nothing{};
    taken_ = newest.version;
    return MillState{&mill_, newest.value};
  }

  Mill& mill_;
  std::optional<std::uint64_t> taken_;  // the version that was taken last
};

Result<rml1::Job> find_job(const rml1::MillController& mill, rml1::JobNumber number) {
  const auto found = std::ranges::find(mill.jobs(), number, &rml1::Job::number);
  if (found != mill.jobs().end()) return *found;
  return fail(Reason::not_found, fmt::format("there is no job {} in the queue", number),
              "`axisctl mill queue` lists them; `axisctl history` has those that have ended");
}

// A repeat acts no more: the job as it is now. One that has left the queue meanwhile had `then` come of it.
void repeat_job(Mill& mill, const Result<Known>& known, rml1::JobNumber number, rml1::JobState then,
                const Answer<CurrentJob>& answer) {
  repeat_done(known, [&](const Result<void>& done) {
    if (!done) return answer(tl::unexpected(done.error()));
    mill.post([&mill, number, then, answer](rml1::MillController& controller, TimePoint now) {
      const Result<rml1::Job> job = find_job(controller, number);
      if (!job && !rml1::is_end(then)) return answer(tl::unexpected(job.error()));
      rml1::Job ended;
      ended.number = number;
      ended.state = then;
      CurrentJob current{&mill, job.value_or(ended), server::moment_of(now)};
      const auto running = controller.running(now);
      if (running && running->number == number) current.run_on = running->run_on;
      answer(std::move(current));
    });
  });
}

// What a job has come to by a request of the kind.
rml1::JobState outcome_of(RequestKind kind) {
  if (kind == RequestKind::cancel_job) return rml1::JobState::cancelled;
  if (kind == RequestKind::continue_job) return rml1::JobState::paused;
  return kind == RequestKind::report_job_done ? rml1::JobState::done : rml1::JobState::running;
}

}  // namespace

Result<void> check_in_time(const MillTurn& turn) {
  if (turn.now <= turn.context.not_after) return {};
  return fail(Reason::deadline_passed, "the request came to the mill after its not_after",
              "ask again, with a later not_after");
}

Problem not_sent_to(const Mill& mill) {
  return {.reason = Reason::link_down,
          .message = fmt::format("the line to {} is closed: the abort is sent when it is back", mill.name()),
          .hint = "use the mill's own emergency stop"};
}

void Mills::get(const Call& call, std::string_view device, Answer<MillState> answer) const {
  pipeline_.ask({RequestKind::get_mill, call, find_mill(gateway_, device)}, std::move(answer),
                [](const MillTurn& turn, const Answer<MillState>& respond) {
                  respond(MillState{&turn.device, std::make_shared<const server::MillNow>(turn.device.now(turn.now))});
                });
}

Opened<MillState> Mills::watch(const Call& call, std::string_view device) const {
  const auto admitted = pipeline_.admit({RequestKind::watch_mill, call, find_mill(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  Result<Streams::Place> place = streams_.take(RequestKind::watch_mill, admitted->caller.who);
  if (!place) return tl::unexpected(place.error());
  return std::make_shared<MillWatch>(*admitted->device, *std::move(place));
}

void Mills::act_on_job(RequestKind kind, const Call& call, std::string_view name, JobAct act,
                       Answer<CurrentJob> answer) const {
  const Result<JobName> found = find_job_name(gateway_, name);
  const rml1::JobNumber number = found ? found->number : 0;
  pipeline_.act(
      {kind, call, device_of(found)},
      [kind, number](const MillTurn& turn) -> Result<std::string> {
        if (const Result<void> in_time = check_in_time(turn); !in_time) return tl::unexpected(in_time.error());
        const Result<rml1::Job> job = find_job(turn.controller, number);
        if (!job) return tl::unexpected(job.error());
        return fmt::format("{} {}", api::name(kind), number);
      },
      [number, act, answer](const MillTurn& turn, const MutationPtr& mutation) {
        const Result<rml1::Job> job = find_job(turn.controller, number);
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

void Mills::confirm(const Call& call, std::string_view job, const rml1::JobSetup& seen,
                    Answer<CurrentJob> answer) const {
  act_on_job(
      RequestKind::confirm_job, call, job,
      [seen](rml1::MillController& mill, const rml1::Job& it, const MillTurn& turn) -> Result<void> {
        if (const Result<void> there = check_at_station(turn.device, turn.caller.who); !there) return there;
        const Result<void> fits = check_setup(turn.device, it);
        return fits ? mill.confirm(it.number, seen, turn.caller.who, turn.now) : fits;
      },
      std::move(answer));
}

void Mills::done(const Call& call, std::string_view job, Answer<CurrentJob> answer) const {
  act_on_job(
      RequestKind::report_job_done, call, job,
      [](rml1::MillController& mill, const rml1::Job& it, const MillTurn& turn) {
        return mill.done(it.number, turn.caller.who, turn.now);
      },
      std::move(answer));
}

void Mills::act_on_run(RequestKind kind, const Call& call, std::string_view device, RunAct act,
                       Answer<CurrentRun> answer) const {
  const auto now = [](const MillTurn& turn) {
    return CurrentRun{&turn.device, turn.controller.running(turn.now), server::moment_of(turn.now)};
  };
  pipeline_.act(
      {kind, call, find_mill(gateway_, device)},
      [kind](const MillTurn& turn) { return check_in_time(turn).map([kind] { return std::string(api::name(kind)); }); },
      [act, now, answer](const MillTurn& turn, const MutationPtr& mutation) {
        const Result<void> done = act(turn);
        if (!done) {
          mutation->failed(done.error());
          return answer(tl::unexpected(done.error()));
        }
        mutation->acted(server::journal::answer_done());
        answer(now(turn));
      },
      [answer](const Problem& problem) { answer(tl::unexpected(problem)); },
      [answer](Mill& mill, const Result<Known>& known) {
        repeat_done(known, [&](const Result<void>& done) {
          if (!done) return answer(tl::unexpected(done.error()));
          mill.post([&mill, answer](rml1::MillController& controller, TimePoint at) {
            answer(CurrentRun{&mill, controller.running(at), server::moment_of(at)});
          });
        });
      });
}

void Mills::pause(const Call& call, std::string_view device, bool raise, Answer<CurrentRun> answer) const {
  act_on_run(
      RequestKind::pause_job, call, device,
      [raise](const MillTurn& turn) { return turn.controller.pause(raise, turn.now); }, std::move(answer));
}

void Mills::resume(const Call& call, std::string_view device, Answer<CurrentRun> answer) const {
  act_on_run(
      RequestKind::resume_job, call, device,
      [](const MillTurn& turn) { return turn.controller.resume(turn.context, turn.now); }, std::move(answer));
}

// No id: an abort always acts, as a stop.
void Mills::abort(const Call& call, std::string_view device, Answer<CurrentRun> answer) const {
  pipeline_.ask({RequestKind::abort_job, call, find_mill(gateway_, device)}, std::move(answer),
                [](const MillTurn& turn, const Answer<CurrentRun>& respond) {
                  audit(RequestKind::abort_job, turn.device, turn.context, "abort");
                  CurrentRun run{&turn.device, turn.controller.running(turn.now), server::moment_of(turn.now)};
                  if (!turn.controller.abort(turn.context, turn.now)) {
                    return respond(tl::unexpected(not_sent_to(turn.device)));
                  }
                  if (const rml1::JobNumber number = turn.controller.running_job(); number != 0) {
                    run.running = turn.controller.running(turn.now);
                    run.executed = find_job(turn.controller, number)->executed;
                  }
                  respond(std::move(run));
                });
}

}  // namespace axisgate::api
