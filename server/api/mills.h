// The jobs of mills: their queue, confirmation at the machine, and the one that runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/problem.h"
#include "device/rml1/mill/mill_controller.h"
#include "server/api/call.h"
#include "server/api/fair_worker.h"
#include "server/api/job_upload.h"
#include "server/api/pipeline.h"
#include "server/api/subscription.h"
#include "server/devices/mill.h"
#include "server/gateway.h"

namespace axisgate::api {

// What runs; nothing: no job.
struct CurrentRun {
  const server::Mill* mill = nullptr;  // never null
  std::optional<rml1::RunningJob> running;
  server::Moment clock;
  std::optional<rml1::PlaceRange> executed{};  // rml1::Job::executed of it
};

struct MillState {
  const server::Mill* mill = nullptr;          // never null
  std::shared_ptr<const server::MillNow> now;  // never null
};

// In the order of the queue; not empty.
struct CancelledJobs {
  const server::Mill* mill = nullptr;  // never null
  std::vector<rml1::JobNumber> jobs;
};

// Where a job continues, in its part; both count from 1. Line 0: none is named.
struct LineToChoose {
  std::uint64_t line = 0, column = 1;
};

// A JobToRepeat says how a job that has ended is queued once more.
struct JobToRepeat {
  bool rest = false;                           // from a line of it on
  LineToChoose from;                           // of the rest
  std::vector<std::string> accepted_warnings;  // beside those that were accepted for it
};

// deadline_passed. While a request was posted or waited for the journal, its caller may have left.
Result<void> check_in_time(const TurnOf<server::Mill>& turn);

// Of an abort: the line is closed.
Problem not_sent_to(const server::Mill& mill);

// Thread safe. The members' problems are those of MillPipeline::admit() and of rml1::MillController.
class Mills {
 public:
  // All outlive this.
  Mills(server::Gateway& gateway, const MillPipeline& pipeline, Streams& streams)
      : gateway_(gateway), pipeline_(pipeline), streams_(streams) {}
  ~Mills() { worker_->join(); }

  // invalid_request, where there is no such tool, origin or profile, or no warning of a name, there are too many parts,
  // or the line cannot stream so; what check_same_workpiece() refuses;
  // queue_full.
  Result<std::unique_ptr<JobUpload>> send(const Call& call, std::string_view device, JobToSend job) const;
  // Fails as server::ended_job(), server::chosen_rest() and JobUpload::finish() do, and with wrong_mode if it has no
  // rest.
  void repeat(const Call& call, std::string_view job, JobToRepeat how, Answer<CurrentJob> answer) const;

  void get(const Call& call, std::string_view device, Answer<MillState> answer) const;
  // The mill whenever it has changed.
  Opened<MillState> watch(const Call& call, std::string_view device) const;

  // not_allowed, where the caller is not at the mill's station.
  void confirm(const Call& call, std::string_view job, const rml1::JobSetup& seen, Answer<CurrentJob> answer) const;
  void start(const Call& call, std::string_view job, Answer<CurrentJob> answer) const;
  void pause(const Call& call, std::string_view device, bool raise, Answer<CurrentRun> answer) const;
  void resume(const Call& call, std::string_view device, Answer<CurrentRun> answer) const;
  // What server::chosen_rest() refuses.
  void choose_rest(const Call& call, std::string_view job, LineToChoose from, Answer<CurrentJob> answer) const;
  // Always acts. link_down: it is sent when the line is back.
  void abort(const Call& call, std::string_view device, Answer<CurrentRun> answer) const;
  // not_allowed: the job is somebody else's.
  void cancel(const Call& call, std::string_view job, Answer<CurrentJob> answer) const;
  // Cancels all jobs of `who` that wait to begin. Fails with not_found if there is none.
  void cancel_all(const Call& call, std::string_view device, std::string who, Answer<CancelledJobs> answer) const;
  // To the front, by an administrator; by its owner, before their other jobs. not_allowed, as cancel().
  void move_first(const Call& call, std::string_view job, Answer<CurrentJob> answer) const;
  void done(const Call& call, std::string_view job, Answer<CurrentJob> answer) const;

 private:
  Result<std::unique_ptr<JobUpload>> begin_upload(RequestKind kind, const Call& call,
                                                  const MillPipeline::Admitted& admitted, JobToSend job,
                                                  JobsBefore before) const;
  Result<std::shared_ptr<JobUpload>> begin_repeat(const Call& call, const MillPipeline::Admitted& admitted,
                                                  rml1::JobNumber number, const JobToRepeat& how) const;
  using JobAct = std::function<Result<void>(rml1::MillController&, const rml1::Job&, const TurnOf<server::Mill>&)>;
  void act_on_job(RequestKind kind, const Call& call, std::string_view job, JobAct act,
                  Answer<CurrentJob> answer) const;
  // Reads the job as it was published last, on the worker, and acts on it with the result.
  template <class Read, class Act>
  void read_and_act(RequestKind kind, const Call& call, std::string_view job, Read read, Act act,
                    Answer<CurrentJob> answer) const;
  using RunAct = std::function<Result<void>(const TurnOf<server::Mill>&)>;
  void act_on_run(RequestKind kind, const Call& call, std::string_view device, RunAct act,
                  Answer<CurrentRun> answer) const;

  server::Gateway& gateway_;
  const MillPipeline& pipeline_;
  Streams& streams_;
  // What reads or writes a whole job: neither on a device's strand nor on a thread that serves others.
  // Shared with what is posted to a mill, which may come to its turn when this is gone.
  const std::shared_ptr<FairWorker> worker_ = std::make_shared<FairWorker>();
};

}  // namespace axisgate::api
