// Interface between the server and a machine that is sent jobs, for jobs in any language. The machine's folder
// implements it.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/jobs/hand_act.h"
#include "device/jobs/job.h"
#include "device/jobs/job_queue.h"
#include "device/jobs/measured_pace.h"
#include "device/jobs/running_job.h"
#include "device/jobs/send_settings.h"
#include "device/use/request_context.h"

namespace axisgate::jobs {

struct MachineSettings {
  SendSettings sending;
  Duration confirmation_lasts = std::chrono::minutes(10);
  Duration busy_limit = std::chrono::minutes(10);  // a machine that takes no byte for this time is reported as busy
  AtLoss at_loss = AtLoss::abort;
  Duration queued_at_most = std::chrono::days(14);  // a job that nobody confirms within this time becomes EXPIRED
};

enum class MachineLink { closed, open };

// A JobRest is the place in its part at which a job continues, with the time and the run-on bound of the rest.
struct JobRest {
  Place from;
  TimeRange takes{};
  RunOn run_on{};
};

// Receives the events of a machine. Called from the functions of the machine; must not call the machine.
class MachineEvents : public QueueEvents, public RunEvents {
 public:
  virtual void link_changed(MachineLink link, std::string_view why, TimePoint now) = 0;
  // Reports that Z0 is sent to the machine. `z0_count`: the new z0_count(), which must be stored for the next run of
  // the daemon.
  virtual void z0_sent(std::uint64_t z0_count) = 0;
  // Reports bytes that were given to the line. `job`: number of the running job; 0 if no job runs.
  virtual void written(std::string_view bytes, JobNumber job) = 0;
  // Reports that somebody requested an abort, with or without a running job.
  virtual void abort_requested(std::string_view by, TimePoint now) = 0;
  // Reports an error of the gateway itself: a state machine received an event that its table does not allow.
  virtual void internal_error(std::string_view what, TimePoint now) = 0;
};

// A PreparedJob is a part of a job that a Model has prepared for sending. Immutable, so threads may share it.
class PreparedJob {
 public:
  virtual ~PreparedJob() = default;

  virtual TimeRange takes() const = 0;
  virtual RunOn run_on() const = 0;
};

// Not thread safe: used only on its device's strand. A request that is refused has no effect.
class Machine : public LineMachine {
 public:
  // Takes over a job of the daemon's previous run, in the order of is_before(). The job is QUEUED, TOOL_CHANGE, PAUSED,
  // FED or PAUSED_UNKNOWN. Job::queued_since must be set; for a PAUSED_UNKNOWN job also Job::written, as far as it is
  // known. Call the four inherit functions before link_up().
  virtual void inherit(Job job) = 0;
  // Takes over the job that was begun last in the daemon's earlier runs, whatever its state is now.
  virtual void inherit_left(const Job& last) = 0;
  // Takes over an abort that the previous run could not send.
  virtual void inherit_abort() = 0;
  // Takes over the z0_count() of the previous run.
  virtual void inherit_z0_count(std::uint64_t z0_count) = 0;

  // Adds the job after all other jobs. Its number must be greater than theirs. A job with JobSetup::from is the rest of
  // another job. Any other job with Job::continues must have Job::z0_count: the z0_count() for which its heights are
  // valid.
  virtual void add(Job job, TimePoint now) = 0;
  // Confirms a job for a person at the machine. Fails with link_down; with wrong_job_state if a job runs; and as
  // Confirmations::check_next() and confirm() do.
  virtual Result<void> confirm(JobNumber job, const JobSetup& seen, std::string by, TimePoint now) = 0;
  // Checks what start() checks, except the bytes and the right to the machine. Fails with not_found; wrong_job_state if
  // a job runs; link_down; not_confirmed if the job is not confirmed, or no longer confirmed; axis_busy.
  virtual Result<void> check_startable(JobNumber job, TimePoint now) = 0;
  // Starts a job. Sends its first byte at once if the machine takes it. `prepared`: the job's next part, prepared by
  // the machine's own Model. Fails as check_startable() and Permission::authorize() do.
  virtual Result<void> start(JobNumber job, std::shared_ptr<const PreparedJob> prepared, const use::RequestContext& by,
                             TimePoint now) = 0;
  // Pauses the running job. If `raise`, the tool is raised after the bytes sent before, and the job is then PAUSED.
  // Fails with wrong_job_state if no job is being sent.
  virtual Result<void> pause(bool raise, TimePoint now) = 0;
  // Resumes a job that is paused with the tool in the cut. Fails with wrong_job_state if there is no such job, and as
  // Permission::authorize() does.
  virtual Result<void> resume(const use::RequestContext& by, TimePoint now) = 0;
  // Sets the place in its part at which a PAUSED_UNKNOWN or PAUSED job continues after it is confirmed and started.
  // Fails with not_found; wrong_job_state if the job is in another state.
  virtual Result<void> choose_rest(JobNumber job, const JobRest& rest, std::string_view by, TimePoint now) = 0;
  // Takes over the plan for the rest of a job, which was computed off the strand. Has no effect if the job no longer
  // continues at the same place.
  virtual void plan_rest(const Job& planned) = 0;
  // Stops writing the running job and sends the abort, even if no job runs. Returns false if the line is closed; the
  // abort is then sent when the line is open again. Another caller whose job is ended or whose lease is affected must
  // rearm before starting a job.
  virtual bool abort(const use::RequestContext& by, TimePoint now) = 0;
  // Aborts in the same manner, but not as a stop: no caller has to rearm.
  virtual bool abort(std::string_view by, TimePoint now) = 0;
  // Cancel a job, or make it DONE. Both fail with not_found; wrong_job_state if the job's state does not allow the
  // event.
  virtual Result<void> cancel(JobNumber job, std::string_view by, TimePoint now) = 0;
  virtual Result<void> done(JobNumber job, std::string_view by, TimePoint now) = 0;
  // Moves a job forward. Fails as JobQueue::move_first() does.
  virtual Result<void> move_first(JobNumber job, Overtaken overtaken, std::string_view by, TimePoint now) = 0;
  // Performs an act by hand and voids the confirmation. Returns the longest time until the machine has performed this
  // act and all acts before it; until then no job and no other step can start. Fails with wrong_job_state if a job
  // runs; link_down; axis_busy; and as Permission::authorize() and Model::longest() do.
  virtual Result<Duration> operate(const HandAct& act, const use::RequestContext& by, TimePoint now) = 0;

  // Jobs that have not ended, in the order of the queue, with the running job.
  virtual const std::vector<Job>& jobs() const = 0;
  virtual std::optional<RunningJob> running(TimePoint now) = 0;
  virtual JobNumber running_job() const = 0;  // 0: no job runs
  // Reports whether no job runs, no bytes of an abort are in this host, and no recovery from an internal error is due.
  virtual bool is_idle() const = 0;
  // Reports whether an abort must still be sent, or has not left this host completely.
  virtual bool abort_waits() const = 0;
  virtual MachineLink link() const = 0;
  // nullopt if no job could measure the pace.
  virtual const std::optional<MeasuredPace>& measured_pace() const = 0;
  // Number of times that Z0 was sent, by hand or by a job.
  virtual std::uint64_t z0_count() const = 0;
};

}  // namespace axisgate::jobs
