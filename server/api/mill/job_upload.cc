#include "server/api/mill/job_upload.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/api/mill/job_acts.h"
#include "server/api/mill/workpiece.h"
#include "server/devices/spooled_jobs.h"
#include "server/journal/answers.h"

namespace axisgate::api {
namespace {

using server::Mill;
using MillTurn = TurnOf<Mill>;

bool same_parts(const jobs::Job& one, const jobs::Job& other) {
  return std::ranges::equal(one.parts, other.parts, [](const jobs::JobPart& a, const jobs::JobPart& b) {
    return a.tool == b.tool && a.end == b.end;
  });
}

// Returns the job of the first of two requests with one id: the newest job that is equal in all members.
Result<CurrentJob> sent_before(Mill& mill, const std::vector<jobs::Job>& jobs, const jobs::Job& again, TimePoint now) {
  const auto same = [&](const jobs::Job& one) {
    return one.setup.digest == again.setup.digest && one.setup.profile == again.setup.profile &&
           one.setup.origin == again.setup.origin && same_parts(one, again) && one.streaming == again.streaming &&
           one.stock == again.stock && one.owner == again.owner && one.name == again.name &&
           one.continues == again.continues;
  };
  const jobs::Job* newest = nullptr;
  for (const jobs::Job& job : jobs) {
    if (same(job) && (newest == nullptr || newest->number < job.number)) newest = &job;
  }
  if (newest != nullptr) return CurrentJob{&mill, *newest, server::moment_of(now)};
  return fail(Reason::not_found, "the job was sent before, and has ended", "`ListHistory` has it");
}

}  // namespace

CurrentJob current(const MillTurn& turn, const jobs::Job& before) {
  CurrentJob now{&turn.device, before, server::moment_of(turn.now)};
  for (const jobs::Job& job : turn.controller.jobs()) {
    if (job.number == before.number) now.job = job;
  }
  const auto running = turn.controller.running(turn.now);
  if (running && running->number == before.number) now.run_on = running->run_on;
  return now;
}

JobUpload::JobUpload(RequestKind kind, const Call& call, const MillPipeline::Admitted& admitted,
                     const MillPipeline& pipeline, FairWorker& worker, JobToSend job, JobsBefore before,
                     const jobs::CheckOptions& options, std::unique_ptr<server::spool::Upload> spooled)
    : kind_(kind),
      call_(call),
      mill_(*admitted.device),
      pipeline_(pipeline),
      identity_(server::identity_of(admitted.caller.who)),
      worker_(worker),
      job_(std::move(job)),
      before_(std::move(before)),
      options_(options),
      spooled_(std::move(spooled)),
      check_(*mill_.config().model, options, mill_.config().sending.buffer, job_.parts, job_.accepted_warnings,
             {before_.accepted}) {}

// Checks only jobs with a new workpiece. Otherwise the jobs before are played first, which takes long: see finish().
Result<void> JobUpload::append(std::string_view bytes) {
  if (before_.cut == 0) {
    if (const Result<void> checked = check_.feed(bytes); !checked) return checked;
  }
  return spooled_->append(bytes);
}

Result<CheckedJob> JobUpload::checked() {
  if (before_.cut == 0) return check_.finish();
  const auto workpiece = workpiece_after(mill_, before_.cut, options_);
  if (!workpiece) return tl::unexpected(workpiece.error());
  JobCheck check(*mill_.config().model, options_, mill_.config().sending.buffer, job_.parts, job_.accepted_warnings,
                 {before_.accepted, workpiece->get()});
  Result<void> fed;
  const Result<void> read = spooled_->read_back([&](std::string_view piece) {
    if (fed) fed = check.feed(piece);
  });
  if (!read) return tl::unexpected(read.error());
  if (!fed) return tl::unexpected(fed.error());
  return check.finish();
}

void JobUpload::finish(std::string digest, const Answer<CurrentJob>& answer) {
  worker_.post(identity_, [this, digest = std::move(digest), answer] { keep(digest, answer); });
}

std::string JobUpload::facts(const CheckedJob& checked) const {
  return server::facts_of({.setup = {"", std::string(mill_.config().model->name()), job_.origin, "", {}, before_.from},
                           .parts = checked.parts,
                           .part = before_.part,
                           .leaves = checked.leaves,
                           .extent = checked.extent,
                           .accepted = checked.accepted,
                           .streaming = job_.streaming,
                           .stock = job_.stock,
                           .continues = before_.continues,
                           .z0_count = before_.z0_count.value_or(0),
                           .checked_for = server::checked_for(mill_.config(), job_.origin)});
}

// Both jobs count heights from the Z0 that was set when the job before began.
Result<void> JobUpload::check_z0(std::uint64_t z0_count) const {
  if (!before_.z0_count || *before_.z0_count == z0_count) return {};
  return fail(Reason::setup_changed, fmt::format("Z0 was sent to the mill since job {} began", before_.cut),
              "send the job without the one that it continues; if Z0 is still the same surface, accept deep-pass");
}

// Answers a repeated request with the job of the first request, and drops the new upload.
void JobUpload::keep(std::string digest, const Answer<CurrentJob>& answer) {
  const Result<CheckedJob> good = checked();
  if (!good) return answer(tl::unexpected(good.error()));
  if (before_.z0_count && good->leaves.surface) {
    return answer(fail(Reason::invalid_request,
                       "the job sets Z0 itself, so its heights are not those of the job before",
                       "send it without the one that it continues"));
  }
  const auto published = mill_.newest().get().value;
  if (const Result<void> same = check_z0(published->z0_count); !same) return answer(tl::unexpected(same.error()));
  spooled_->set_facts(facts(*good));
  Result<server::spool::Job> spooled = spooled_->finish();
  if (!spooled) return answer(tl::unexpected(spooled.error()));
  call_.digest = std::move(digest);
  jobs::Job job = server::job_of(*spooled);
  const auto drop = [&mill = mill_, number = job.number] { mill.drop_spooled(number); };
  const Result<void> planned =
      server::plan_job(mill_.spool(), mill_.name(), mill_.config(), job, mill_.newest().get().value->measured_pace);
  if (!planned) {
    drop();
    return answer(tl::unexpected(planned.error()));
  }
  pipeline_.act(
      {kind_, call_, Result<Mill*>(&mill_)},
      [this, text = fmt::format("{} {}", api::name(kind_), job.number), answer](const MillTurn& turn) {
        return check_in_time(turn).and_then([&] { return check_z0(turn.controller.z0_count()); }).map([&text] {
          return text;
        });
      },
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
          mill.post([&mill, job, answer](jobs::Machine& controller, TimePoint now) {
            answer(sent_before(mill, controller.jobs(), job, now));
          });
        });
      });
}

}  // namespace axisgate::api
