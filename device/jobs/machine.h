// Interface of a machine that is sent jobs to the server, whatever language the jobs have. The machine's folder
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
  Duration busy_limit = std::chrono::minutes(10);  // time without a byte taken after which the machine counts as busy
  AtLoss at_loss = AtLoss::abort;
  Duration queued_at_most = std::chrono::days(14);  // a job that nobody has confirmed by then ends EXPIRED
};

enum class MachineLink { closed, open };

// JobRest is the place where a job continues, with the time that its part then takes.
struct JobRest {
  Place from;
  TimeRange takes{};
  RunOn run_on{};
};

// Listens to a machine. Called from within the machine's members; must not call back.
class MachineEvents : public QueueEvents, public RunEvents {
 public:
  virtual void link_changed(MachineLink link, std::string_view why, TimePoint now) = 0;
  // Z0 is sent. The new surfaces() must be kept: it outlives the daemon.
  virtual void surface_set(std::uint64_t surfaces) = 0;
  // The bytes were given to the line, for a job or, with 0, for none.
  virtual void written(std::string_view bytes, JobNumber job) = 0;
  // Somebody requested an abort, whether a job runs or none.
  virtual void abort_requested(std::string_view by, TimePoint now) = 0;
  // A state machine had an event that its table does not have: an error of the gateway's own.
  virtual void internal_error(std::string_view what, TimePoint now) = 0;
};

// A PreparedJob is a part of a job as a Model has prepared it to be sent. Immutable, so threads may share it.
class PreparedJob {
 public:
  virtual ~PreparedJob() = default;

  virtual TimeRange takes() const = 0;
  virtual RunOn run_on() const = 0;
};

// Not thread safe: lives on its device's strand. A request that is refused has no effect.
class Machine : public LineMachine {
 public:
  // Takes over a job of the run of the daemon before this one: QUEUED, TOOL_CHANGE, PAUSED, FED, or PAUSED_UNKNOWN with
  // what is known to be `written`; with its queued_since. It has the place that is_before() gives it. Call it, and the
  // other three, before link_up().
  virtual void inherit(Job job) = 0;
  // Takes over the job that was begun last in the runs before, whatever has become of it.
  virtual void inherit_left(const Job& last) = 0;
  // Takes over an abort that the run before could no longer send.
  virtual void inherit_abort() = 0;
  // Takes over surfaces() of the run before.
  virtual void inherit_surfaces(std::uint64_t surfaces) = 0;

  // Puts the job after all others. The numbers ascend. With JobSetup::from it is the rest of another job. Otherwise,
  // with Job::continues, Job::surfaces is the surfaces() with which its heights count.
  virtual void add(Job job, TimePoint now) = 0;
  // Confirms a job for somebody at the machine. Fails with link_down; wrong_mode if a job runs; and as
  // Confirmations::confirm() does.
  virtual Result<void> confirm(JobNumber job, const JobSetup& seen, std::string by, TimePoint now) = 0;
  // Fails as start() does, as far as that needs neither the bytes nor the right to the machine: not_found; wrong_mode;
  // not_allowed if it is no longer confirmed; link_down; axis_busy.
  virtual Result<void> check_startable(JobNumber job, TimePoint now) = 0;
  // Starts a job: its first byte goes out if the machine takes it. `prepared` is by the machine's own Model, of the
  // bytes of the job's next part. Fails as check_startable() and Permission::authorize() do.
  virtual Result<void> start(JobNumber job, std::shared_ptr<const PreparedJob> prepared, const use::RequestContext& by,
                             TimePoint now) = 0;
  // Pauses the running job. `raise`: after what was sent, the tool is raised and the job is PAUSED. Fails with
  // wrong_mode if no job is being sent.
  virtual Result<void> pause(bool raise, TimePoint now) = 0;
  // Fails with wrong_mode if no job is paused with the tool in the cut, and as Permission::authorize() does.
  virtual Result<void> resume(const use::RequestContext& by, TimePoint now) = 0;
  // Lets a job that is PAUSED_UNKNOWN or PAUSED continue at that place of its part, once it is confirmed and started.
  // Fails with not_found; wrong_mode.
  virtual Result<void> choose_rest(JobNumber job, const JobRest& rest, std::string_view by, TimePoint now) = 0;
  // Takes over the plan of a rest that was computed off the strand, if the job still continues there.
  virtual void plan_rest(const Job& planned) = 0;
  // Aborts: nothing of the running job is written after it. The machine is sent the abort even if no job runs. Returns
  // false if the line is closed; then it is sent when the line is back. Nobody whose job it ends, or whose lease it
  // concerns, may start another one before they rearm.
  virtual bool abort(const use::RequestContext& by, TimePoint now) = 0;
  // Aborts without holding anybody back: it ends the job and is no stop.
  virtual bool abort(std::string_view by, TimePoint now) = 0;
  // Fails with not_found; wrong_mode if the job's state does not have it.
  virtual Result<void> cancel(JobNumber job, std::string_view by, TimePoint now) = 0;
  virtual Result<void> done(JobNumber job, std::string_view by, TimePoint now) = 0;
  // Moves a job forward. Fails as JobQueue::move_first() does.
  virtual Result<void> move_first(JobNumber job, Overtaken overtaken, std::string_view by, TimePoint now) = 0;
  // Does an act by hand while no job runs; what was confirmed is void. Returns the time after which the machine has
  // done it, and all that was sent before; until then no job is started, and no other step. Fails with wrong_mode;
  // link_down; axis_busy; and as Permission::authorize() and Model::longest() do.
  virtual Result<Duration> operate(const HandAct& act, const use::RequestContext& by, TimePoint now) = 0;

  // Jobs that have not ended, in the order of the queue; the one that runs is among them.
  virtual const std::vector<Job>& jobs() const = 0;
  virtual std::optional<RunningJob> running(TimePoint now) = 0;
  virtual JobNumber running_job() const = 0;  // 0: none
  // Reports whether no job runs, no abort leaves this host, and no internal error has to be recovered from.
  virtual bool is_idle() const = 0;
  // Reports whether an abort is to be sent, or has not left this host.
  virtual bool abort_waits() const = 0;
  virtual MachineLink link() const = 0;
  // nullopt if no job has shown it.
  virtual const std::optional<MeasuredPace>& measured_pace() const = 0;
  // Number of times that Z0 was sent, by hand or by a job.
  virtual std::uint64_t surfaces() const = 0;
};

}  // namespace axisgate::jobs
