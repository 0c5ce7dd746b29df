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

// Of one that has just left the queue as it was before, with the state that it has come to.
CurrentJob current(const MillTurn& turn, const rml1::Job& before) {
  CurrentJob now{&turn.device, before, server::moment_of(turn.now)};
  for (const rml1::Job& job : turn.controller.jobs()) {
    if (job.number == before.number) now.job = job;
  }
  const auto running = turn.controller.running(turn.now);
  if (running && running->number == before.number) now.run_on = running->run_on;
  return now;
}

Result<rml1::Job> find_job(const rml1::MillController& mill, rml1::JobNumber number) {
  const auto found = std::ranges::find(mill.jobs(), number, &rml1::Job::number);
  if (found != mill.jobs().end()) return *found;
  return fail(Reason::not_found, fmt::format("there is no job {} in the queue", number),
              "`axisctl mill queue` lists them; `axisctl history` has those that have ended");
}

bool same_parts(const rml1::Job& one, const rml1::Job& other) {
  return std::ranges::equal(one.parts, other.parts, [](const rml1::JobPart& a, const rml1::JobPart& b) {
    return a.tool == b.tool && a.end == b.end;
  });
}

// The job of the first of two requests with one id: the newest that is the same in all.
Result<CurrentJob> sent_before(Mill& mill, const std::vector<rml1::Job>& jobs, const rml1::Job& again, TimePoint now) {
  const auto same = [&](const rml1::Job& one) {
    return one.setup.digest == again.setup.digest && one.setup.profile == again.setup.profile &&
           one.setup.origin == again.setup.origin && same_parts(one, again) && one.streaming == again.streaming &&
           one.stock == again.stock && one.owner == again.owner && one.name == again.name;
  };
  const rml1::Job* newest = nullptr;
  for (const rml1::Job& job : jobs) {
    if (same(job) && (newest == nullptr || newest->number < job.number)) newest = &job;
  }
  if (newest != nullptr) return CurrentJob{&mill, *newest, server::moment_of(now)};
  return fail(Reason::not_found, "the job was sent before, and has ended", "`axisctl history` has it");
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

JobUpload::JobUpload(const Call& call, const MillPipeline::Admitted& admitted, const MillPipeline& pipeline,
                     FairWorker& worker, JobToSend job, const rml1::CheckOptions& options,
                     std::unique_ptr<server::spool::Upload> spooled)
    : call_(call),
      mill_(*admitted.device),
      pipeline_(pipeline),
      identity_(server::identity_of(admitted.caller.who)),
      worker_(worker),
      job_(std::move(job)),
      spooled_(std::move(spooled)),
      check_(mill_.config().profile, options, mill_.config().sending.buffer, job_.parts, job_.accepted_warnings) {}

Result<void> JobUpload::append(std::string_view bytes) {
  const Result<void> checked = check_.feed(bytes);
  return checked ? spooled_->append(bytes) : checked;
}

void JobUpload::finish(std::string digest, const Answer<CurrentJob>& answer) {
  worker_.post(identity_, [this, digest = std::move(digest), answer] { keep(digest, answer); });
}

// A repeat of a request that came before is answered with the job of that one, and what came now is dropped.
void JobUpload::keep(std::string digest, const Answer<CurrentJob>& answer) {
  const Result<CheckedJob> checked = check_.finish();
  if (!checked) return answer(tl::unexpected(checked.error()));
  spooled_->set_facts(server::facts_of({.setup = {"", mill_.config().profile.name, job_.origin, ""},
                                        .parts = checked->parts,
                                        .leaves = checked->leaves,
                                        .extent = checked->extent,
                                        .accepted = checked->accepted,
                                        .streaming = job_.streaming,
                                        .stock = job_.stock,
                                        .checked_for = server::checked_for(mill_.config(), job_.origin)}));
  Result<server::spool::Job> spooled = spooled_->finish();
  if (!spooled) return answer(tl::unexpected(spooled.error()));
  call_.digest = std::move(digest);
  rml1::Job job = server::job_of(*spooled);
  const auto drop = [&mill = mill_, number = job.number] { mill.drop_spooled(number); };
  const Result<void> planned =
      server::plan_job(mill_.spool(), mill_.name(), mill_.config(), job, mill_.newest().get().value->measured_pace);
  if (!planned) {
    drop();
    return answer(tl::unexpected(planned.error()));
  }
  pipeline_.act(
      {RequestKind::send_job, call_, Result<Mill*>(&mill_)},
      [number = job.number](const MillTurn&) { return Result<std::string>(fmt::format("send job {}", number)); },
      [job, answer](const MillTurn& turn, const MutationPtr& mutation) {
        turn.controller.add(job, turn.now);
        mutation->acted(server::journal::answer_done());
        answer(current(turn, job));
      },
      [drop, answer](const Problem& problem) {
        drop();
        answer(tl::unexpected(problem));
      },
      [drop, answer, job](Mill& mill, const Result<Known>& known) {
        drop();
        repeat_done(known, [&](const Result<void>& done) {
          if (!done) return answer(tl::unexpected(done.error()));
          mill.post([&mill, job, answer](rml1::MillController& controller, TimePoint now) {
            answer(sent_before(mill, controller.jobs(), job, now));
          });
        });
      });
}

Result<std::unique_ptr<JobUpload>> Mills::send(const Call& call, std::string_view device, JobToSend job) const {
  const auto admitted = pipeline_.admit({RequestKind::send_job, call, find_mill(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  Mill& mill = *admitted->device;
  const server::MillConfig& config = mill.config();
  if (const Result<void> parts = check_parts(job.parts, config.tools, mill.name()); !parts)
    return tl::unexpected(parts.error());
  if (job.streaming == rml1::Streaming::full && !config.holds_host_back) {
    return fail(
        Reason::invalid_request,
        fmt::format("nothing holds the host back while the buffer of {} is full, so bytes would be lost", mill.name()),
        "send the job without a streaming of its own");
  }
  if (const Result<void> names = check_warning_names(job.accepted_warnings); !names)
    return tl::unexpected(names.error());
  Result<std::string> made_for = machine_with_profile(config, job.made_for);
  if (!made_for) return tl::unexpected(made_for.error());
  rml1::CheckOptions options;
  options.stock = job.stock;
  options.others = config.others;
  options.made_for = *std::move(made_for);
  if (!job.origin.empty()) {
    const auto origin = std::ranges::find(config.origins, job.origin, &server::NamedOrigin::name);
    if (origin == config.origins.end()) {
      return fail(Reason::invalid_request, fmt::format("{} has no origin \"{}\"", mill.name(), job.origin),
                  "`axisctl mill queue` lists them; none is the one that is set at the panel");
    }
    options.origin = server::origin_of(*origin, config.profile);
  }
  auto spooled = mill.spool().begin(mill.name(), {.name = job.title,
                                                  .who = admitted->caller.who,
                                                  .identity = server::queued_as(admitted->caller.who),
                                                  .created = server::calendar_now()});
  if (!spooled) return tl::unexpected(spooled.error());
  return std::make_unique<JobUpload>(call, *admitted, pipeline_, *worker_, std::move(job), options,
                                     *std::move(spooled));
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
