#include "server/api/mill/job_sending.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "server/api/mill/job_setup.h"
#include "server/api/mill/workpiece.h"
#include "server/api/request/names.h"
#include "server/devices/spooled_jobs.h"

namespace axisgate::api {
namespace {

using server::Mill;

Result<void> check_streaming(const Mill& mill, const std::optional<jobs::Streaming>& streaming) {
  if (streaming != jobs::Streaming::full || mill.config().holds_host_back) return {};
  return fail(
      Reason::invalid_request,
      fmt::format("nothing holds the host back while the buffer of {} is full, so bytes would be lost", mill.name()),
      "send the job without a streaming of its own");
}

Result<jobs::CheckOptions> check_options(const Mill& mill, const JobToSend& job) {
  const server::MillConfig& config = mill.config();
  jobs::CheckOptions options;
  options.stock = job.stock;
  if (!job.made_for.empty()) {
    Result<std::string> made_for = config.model->machine_named(job.made_for);
    if (!made_for) return tl::unexpected(made_for.error());
    options.made_for = *std::move(made_for);
  }
  if (job.origin.empty()) return options;
  const auto origin = std::ranges::find(config.origins, job.origin, &jobs::NamedOrigin::name);
  if (origin == config.origins.end()) {
    std::vector<std::string> names;
    for (const jobs::NamedOrigin& one : config.origins) names.push_back(one.name);
    return fail(Reason::invalid_request, fmt::format("{} has no origin \"{}\"", mill.name(), job.origin),
                names.empty()
                    ? "name none: then it is the one that is set at the panel"
                    : fmt::format("it has {}; none is the one that is set at the panel", fmt::join(names, ", ")));
  }
  options.origin = config.model->place_of(*origin);
  return options;
}

std::vector<PartToSend> parts_of(const jobs::Job& job) {
  if (job.parts.size() == 1) return {{job.parts.front().tool}};
  std::vector<PartToSend> parts;
  std::uint64_t begin = 0;
  for (const jobs::JobPart& part : job.parts) parts.push_back({part.tool, part.end - std::exchange(begin, part.end)});
  return parts;
}

// Describes the whole job, also for a rest, so that lines are counted as in its file.
JobToSend copy_of(const jobs::Job& job, std::vector<std::string> accepted) {
  return {.title = job.name,
          .origin = job.setup.origin,
          .parts = parts_of(job),
          .accepted_warnings = std::move(accepted),
          .streaming = job.streaming,
          .stock = job.stock};
}

Result<void> check_has_rest(const jobs::Job& job) {
  const bool was_begun = job.executed || job.written || job.part > 0;
  const bool is_cut_off = job.state == jobs::JobState::aborted || job.state == jobs::JobState::cancelled;
  if (is_cut_off && was_begun) return {};
  return fail(Reason::wrong_job_state,
              fmt::format("{} is {}{}: it has no rest", text_of(job), name(job.state),
                          is_cut_off ? ", and was never begun" : ""),
              "`RepeatJob` without `rest` queues all of it");
}

}  // namespace

Result<std::unique_ptr<JobUpload>> JobSending::begin_upload(RequestKind kind, const Call& call,
                                                            const MillPipeline::Admitted& admitted, JobToSend job,
                                                            JobsBefore before) const {
  Mill& mill = *admitted.device;
  if (const Result<void> parts = check_parts(job.parts, mill.config().tools, mill.name()); !parts)
    return tl::unexpected(parts.error());
  if (const Result<void> can = check_streaming(mill, job.streaming); !can) return tl::unexpected(can.error());
  for (const std::string& name : job.accepted_warnings) {
    if (const Result<void> known = mill.config().model->check_warning_name(name); !known) {
      return tl::unexpected(known.error());
    }
  }
  const Result<jobs::CheckOptions> options = check_options(mill, job);
  if (!options) return tl::unexpected(options.error());
  auto spooled = mill.spool().begin(mill.name(), {.name = job.title,
                                                  .who = admitted.caller.who,
                                                  .identity = server::queued_as(admitted.caller.who),
                                                  .created = server::calendar_now()});
  if (!spooled) return tl::unexpected(spooled.error());
  return std::make_unique<JobUpload>(kind, call, admitted, pipeline_, *worker_, std::move(job), std::move(before),
                                     *options, *std::move(spooled));
}

Result<std::unique_ptr<JobUpload>> JobSending::send(const Call& call, std::string_view device, JobToSend job) const {
  const auto admitted = pipeline_.admit({RequestKind::send_job, call, find_mill(gateway_, device)});
  if (!admitted) return tl::unexpected(admitted.error());
  JobsBefore before;
  if (!job.continues.empty()) {
    const Mill& mill = *admitted->device;
    const Result<JobName> named = find_job_name(gateway_, job.continues);
    if (!named) return tl::unexpected(named.error());
    if (named->device != admitted->device) {
      return fail(Reason::invalid_request, fmt::format("{} is a job of another mill", job.continues),
                  fmt::format("name a job of {}", mill.name()));
    }
    const Result<jobs::Job> ended = server::ended_job(mill.spool(), mill.name(), named->number);
    if (!ended) return tl::unexpected(ended.error());
    const Result<void> same = check_same_workpiece(mill, *ended, job.origin, job.stock);
    if (!same) return tl::unexpected(same.error());
    before = {.continues = ended->number, .cut = ended->number, .z0_count = ended->z0_count};
  }
  return begin_upload(RequestKind::send_job, call, *admitted, std::move(job), std::move(before));
}

Result<std::shared_ptr<JobUpload>> JobSending::begin_repeat(const Call& call, const MillPipeline::Admitted& admitted,
                                                            jobs::JobNumber number, const JobToRepeat& how) const {
  Mill& mill = *admitted.device;
  const Result<jobs::Job> ended = server::ended_job(mill.spool(), mill.name(), number);
  if (!ended) return tl::unexpected(ended.error());
  JobsBefore before{.accepted = ended->accepted};
  if (how.rest) {
    if (const Result<void> has = check_has_rest(*ended); !has) return tl::unexpected(has.error());
    const Result<jobs::Place> from =
        server::chosen_rest(mill.spool(), mill.name(), mill.config(), *ended, how.from.line, how.from.column);
    if (!from) return tl::unexpected(from.error());
    before.continues = number;
    before.cut = ended->continues;
    before.from = *from;
    before.part = ended->part;
  }
  const Result<std::string> bytes = mill.spool().read(mill.name(), number);
  if (!bytes) return tl::unexpected(bytes.error());
  Result<std::unique_ptr<JobUpload>> upload =
      begin_upload(RequestKind::repeat_job, call, admitted, copy_of(*ended, how.accepted_warnings), std::move(before));
  if (!upload) return tl::unexpected(upload.error());
  if (const Result<void> taken = (*upload)->append(*bytes); !taken) return tl::unexpected(taken.error());
  return std::shared_ptr<JobUpload>(*std::move(upload));
}

// Waits for the spool, because it stores the end of a job shortly after the job has left the queue.
void JobSending::repeat(const Call& call, std::string_view name, JobToRepeat how, Answer<CurrentJob> answer) const {
  const Result<JobName> found = find_job_name(gateway_, name);
  const auto admitted = pipeline_.admit({RequestKind::repeat_job, call, device_of(found)});
  if (!admitted) return answer(tl::unexpected(admitted.error()));
  const auto on_worker = [this, call, admitted = *admitted, number = found->number, how = std::move(how), answer] {
    const Result<std::shared_ptr<JobUpload>> upload = begin_repeat(call, admitted, number, how);
    if (!upload) return answer(tl::unexpected(upload.error()));
    (*upload)->finish(call.digest, [upload, answer](Result<CurrentJob> job) { answer(std::move(job)); });
  };
  Mill& mill = *admitted->device;
  mill.post([&mill, worker = worker_, on_worker, identity = server::identity_of(admitted->caller.who)](jobs::Machine&,
                                                                                                       TimePoint) {
    mill.when_kept([worker, on_worker, identity] { worker->post(identity, on_worker); });
  });
}

}  // namespace axisgate::api
