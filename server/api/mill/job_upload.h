// Upload of a job: the bytes are checked, stored in the spool, and queued for the mill.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/jobs/check.h"
#include "device/jobs/machine.h"
#include "server/api/mill/job_check.h"
#include "server/api/request/call.h"
#include "server/api/request/fair_worker.h"
#include "server/api/request/pipeline.h"
#include "server/devices/mill.h"
#include "server/spool/spool.h"

namespace axisgate::api {

using MillPipeline = PipelineOf<server::Mill>;

// A CurrentJob is a job as it is now.
struct CurrentJob {
  const server::Mill* mill = nullptr;  // never null
  jobs::Job job;
  server::Moment clock;                 // converts the job's times for people
  std::optional<jobs::RunOn> run_on{};  // nullopt unless the job runs
};

// Returns the job in its newest state, or `before` if it has just left the queue.
CurrentJob current(const TurnOf<server::Mill>& turn, const jobs::Job& before);

// A JobToSend describes a job before its bytes arrive.
struct JobToSend {
  std::string title, origin;
  std::vector<PartToSend> parts;
  std::vector<std::string> accepted_warnings;  // of the check
  std::optional<jobs::Streaming> streaming{};  // nullopt: the mill's default
  std::optional<jobs::Stock> stock{};
  std::string made_for{};   // name of a profile; empty: the job itself decides
  std::string continues{};  // name of the job whose workpiece it continues; empty: a new workpiece
};

// JobsBefore relates a new job to ended jobs.
struct JobsBefore {
  jobs::JobNumber continues = 0;            // see jobs::Job::continues
  jobs::JobNumber cut = 0;                  // newest job that cut the workpiece before; 0: none
  std::optional<std::uint64_t> z0_count{};  // Machine::z0_count() when job `cut` began; nullopt: any
  std::vector<std::string> accepted{};      // accepted for the repeated job, in addition to those of JobToSend
  std::optional<jobs::Place> from{};        // start of the rest of the repeated job, in `part`
  std::size_t part = 0;
};

// A JobUpload is used by one thread at a time. If it is destroyed before finish(), nothing of the job is kept.
class JobUpload {
 public:
  // `kind` is send_job or repeat_job.
  JobUpload(RequestKind kind, const Call& call, const MillPipeline::Admitted& admitted, const MillPipeline& pipeline,
            FairWorker& worker, JobToSend job, JobsBefore before, const jobs::CheckOptions& options,
            std::unique_ptr<server::spool::Upload> spooled);

  // Fails with queue_full if the spool has no room for more, and as JobCheck::feed() does.
  Result<void> append(std::string_view bytes);
  // Checks, stores and queues the job. `digest` is that of the whole request. Fails as JobCheck::finish() and
  // workpiece_after() do, and with setup_changed if Z0 was sent since the job before began. `answer` must keep this
  // object alive until it is called.
  void finish(std::string digest, const Answer<CurrentJob>& answer);

 private:
  void keep(std::string digest, const Answer<CurrentJob>& answer);
  Result<CheckedJob> checked();
  std::string facts(const CheckedJob& checked) const;
  Result<void> check_z0(std::uint64_t z0_count) const;

  const RequestKind kind_;
  Call call_;
  server::Mill& mill_;
  const MillPipeline& pipeline_;
  const std::string identity_;
  FairWorker& worker_;
  const JobToSend job_;
  const JobsBefore before_;
  const jobs::CheckOptions options_;
  const std::unique_ptr<server::spool::Upload> spooled_;
  JobCheck check_;  // used if the workpiece is new
};

}  // namespace axisgate::api
