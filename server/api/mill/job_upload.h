// A job whose bytes come: checked, kept in the spool, and put into the queue of its mill.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/rml1/check/check.h"
#include "device/rml1/mill/mill_controller.h"
#include "server/api/mill/job_check.h"
#include "server/api/request/call.h"
#include "server/api/request/fair_worker.h"
#include "server/api/request/pipeline.h"
#include "server/devices/mill.h"
#include "server/spool/spool.h"

namespace axisgate::api {

using MillPipeline = PipelineOf<server::Mill>;

// A job as it is now.
struct CurrentJob {
  const server::Mill* mill = nullptr;  // never null
  rml1::Job job;
  server::Moment clock;                 // converts its times for people
  std::optional<rml1::RunOn> run_on{};  // empty unless it runs
};

// Returns the job in its newest state, or `before` if it has just left the queue.
CurrentJob current(const TurnOf<server::Mill>& turn, const rml1::Job& before);

// A JobToSend is what is said of a job before its bytes come.
struct JobToSend {
  std::string title, origin;
  std::vector<PartToSend> parts;
  std::vector<std::string> accepted_warnings;  // names of rml1::Warning
  std::optional<rml1::Streaming> streaming{};  // none: as the mill has it
  std::optional<rml1::Stock> stock{};
  std::string made_for{};   // the name of a profile; empty: it is judged by the job
  std::string continues{};  // the name of the job whose workpiece it continues; empty: the workpiece is new
};

// The JobsBefore are what a new job has in common with jobs that have ended.
struct JobsBefore {
  rml1::JobNumber continues = 0;            // as rml1::Job::continues
  rml1::JobNumber cut = 0;                  // the newest that has cut its workpiece before it begins; 0: none
  std::optional<std::uint64_t> surfaces{};  // MillController::surfaces() with which that one began; none: any
  std::vector<rml1::Warning> accepted{};    // with the job that is repeated, beside those of JobToSend
  std::optional<rml1::Place> from{};        // where the rest of the job that is repeated begins, in `part`
  std::size_t part = 0;
};

// A JobUpload is used by one thread at a time. If it is destroyed before finish(), nothing is left of it.
class JobUpload {
 public:
  // `kind`: send_job, or repeat_job.
  JobUpload(RequestKind kind, const Call& call, const MillPipeline::Admitted& admitted, const MillPipeline& pipeline,
            FairWorker& worker, JobToSend job, JobsBefore before, const rml1::CheckOptions& options,
            std::unique_ptr<server::spool::Upload> spooled);

  // queue_full, where the spool has no room for more; what JobCheck::feed() refuses.
  Result<void> append(std::string_view bytes);
  // `digest`: of the whole request. What JobCheck::finish() and workpiece_after() refuse; stale_setpoint: Z0 was sent
  // since the job before began. What `answer` holds outlives this.
  void finish(std::string digest, const Answer<CurrentJob>& answer);

 private:
  void keep(std::string digest, const Answer<CurrentJob>& answer);
  Result<CheckedJob> checked();
  std::string facts(const CheckedJob& checked) const;
  Result<void> check_surface(std::uint64_t surfaces) const;

  const RequestKind kind_;
  Call call_;
  server::Mill& mill_;
  const MillPipeline& pipeline_;
  const std::string identity_;
  FairWorker& worker_;
  const JobToSend job_;
  const JobsBefore before_;
  const rml1::CheckOptions options_;
  const std::unique_ptr<server::spool::Upload> spooled_;
  JobCheck check_;  // of a job whose workpiece is new
};

}  // namespace axisgate::api
