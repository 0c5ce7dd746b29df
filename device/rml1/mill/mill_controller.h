// One mill: wires its queue, confirmations, running job, abort and work by hand to a line. README.md says what each
// state means.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/core/violations.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/mill/by_hand.h"
#include "device/rml1/mill/confirmations.h"
#include "device/rml1/mill/hand_work.h"
#include "device/rml1/mill/job.h"
#include "device/rml1/mill/job_queue.h"
#include "device/rml1/mill/job_run.h"
#include "device/rml1/mill/prepared_job.h"
#include "device/rml1/mill/rights.h"
#include "device/rml1/mill/setup_left.h"
#include "device/rml1/sending/abort.h"
#include "device/rml1/sending/settings.h"
#include "device/stage/permission.h"
#include "device/stage/requests.h"

namespace axisgate::rml1 {

struct MillSettings {
  SendSettings sending;
  Duration confirmation_lasts = std::chrono::minutes(10);
  Duration busy_limit = std::chrono::minutes(10);  // a mill that has taken no byte for so long is reported as busy
  AtLoss at_loss = AtLoss::abort;
  Duration queued_at_most = std::chrono::days(14);  // a job that nobody has confirmed by then ends EXPIRED
};

enum class MillLink { closed, open };

// JobRest is the place where a job continues, with the time that its part then takes.
struct JobRest {
  Place from;
  TimeRange takes{};
  RunOn run_on{};
};

// Listens to a mill. Called from within the controller's members; must not call back.
class MillEvents : public QueueEvents, public RunEvents {
 public:
  virtual void link_changed(MillLink link, std::string_view why, TimePoint now) = 0;
  // Z0 is sent. The new surfaces() must be kept: it outlives the daemon.
  virtual void surface_set(std::uint64_t surfaces) = 0;
  // The bytes were given to the line, for a job or, with 0, for none.
  virtual void written(std::string_view bytes, JobNumber job) = 0;
  // Somebody requested an abort, whether a job runs or none.
  virtual void abort_requested(std::string_view by, TimePoint now) = 0;
  // A state machine of the mill had an event that its table does not have: an error of the gateway's own.
  virtual void internal_error(std::string_view what, TimePoint now) = 0;
};

// Not thread safe: lives on its device's strand. A request that is refused has no effect.
class MillController : public LineMachine, private Violations {
 public:
  // The referenced objects must outlive this one.
  MillController(const Profile& profile, const MillSettings& settings, FlowLink& line, MillEvents& events,
                 stage::Permission& permission);

  // Takes over a job of the run of the daemon before this one: QUEUED, TOOL_CHANGE, PAUSED, FED, or PAUSED_UNKNOWN with
  // what is known to be `written`; with its queued_since. It has the place that is_before() gives it. Call it, and the
  // other three, before link_up().
  void inherit(Job job);
  // Takes over the job that was begun last in the runs before, whatever has become of it.
  void inherit_left(const Job& last);
  // Takes over an abort that the run before could no longer send.
  void inherit_abort() { abort_.postpone(); }
  // Takes over surfaces() of the run before.
  void inherit_surfaces(std::uint64_t surfaces) { left_.inherit_surfaces(surfaces); }

  // Puts the job after all others. The numbers ascend. With JobSetup::from it is the rest of another job. Otherwise,
  // with Job::continues, Job::surfaces is the surfaces() with which its heights count.
  void add(Job job, TimePoint now) { queue_.add(std::move(job), now); }
  // Confirms a job for somebody at the mill. Fails with link_down; wrong_mode if a job runs; and as
  // Confirmations::confirm() does.
  Result<void> confirm(JobNumber job, const JobSetup& seen, std::string by, TimePoint now);
  // Fails as start() does, as far as that needs neither the bytes nor the right to the mill: not_found; wrong_mode;
  // not_allowed if it is no longer confirmed; link_down; axis_busy.
  Result<void> check_startable(JobNumber job, TimePoint now);
  // Starts a job: its first byte goes out if the mill takes it. `prepared` is of the bytes of its next part. Fails as
  // check_startable() and Permission::authorize() do.
  Result<void> start(JobNumber job, std::shared_ptr<const PreparedJob> prepared, const stage::RequestContext& by,
                     TimePoint now);
  // Pauses the running job. Fails as JobRun::pause() does.
  Result<void> pause(bool raise, TimePoint now) { return run_.pause(raise, now); }
  // Fails with wrong_mode if no job is paused with the tool in the cut, and as Permission::authorize() does.
  Result<void> resume(const stage::RequestContext& by, TimePoint now);
  // Lets a job that is PAUSED_UNKNOWN or PAUSED continue at that place of its part, once it is confirmed and started.
  // Fails with not_found; wrong_mode.
  Result<void> choose_rest(JobNumber job, const JobRest& rest, std::string_view by, TimePoint now);
  // Takes over the plan of a rest that was computed off the strand, if the job still continues there.
  void plan_rest(const Job& planned);
  // Aborts: nothing of the running job is written after it. The mill is sent the abort even if none runs. Returns false
  // if the line is closed; then it is sent when the line is back. Nobody whose job it ends, or whose lease it concerns,
  // may start another one before they rearm.
  bool abort(const stage::RequestContext& by, TimePoint now);
  // Aborts without holding anybody back: it ends the job and is no stop.
  bool abort(std::string_view by, TimePoint now);
  // Fails with not_found; wrong_mode if the job's state does not have it.
  Result<void> cancel(JobNumber job, std::string_view by, TimePoint now);
  Result<void> done(JobNumber job, std::string_view by, TimePoint now);
  // Moves a job forward. Fails as JobQueue::move_first() does.
  Result<void> move_first(JobNumber job, Overtaken overtaken, std::string_view by, TimePoint now) {
    return queue_.move_first(job, overtaken, by, now);
  }
  // Does an act by hand while no job runs; what was confirmed is void. Returns the time after which the mill has done
  // it, and all that was sent before; until then no job is started, and no other step. Fails with wrong_mode;
  // link_down; axis_busy; and as Permission::authorize() and words_of() do.
  Result<Duration> operate(const HandAct& act, const stage::RequestContext& by, TimePoint now);
  // Voids what was confirmed. `why`: for people.
  void setup_changed(std::string_view why, TimePoint now) { confirmations_.make_void(why, now); }

  // Jobs that have not ended, in the order of the queue; the one that runs is among them.
  const std::vector<Job>& jobs() const { return queue_.jobs(); }
  std::optional<RunningJob> running(TimePoint now) { return run_.view(now); }
  JobNumber running_job() const { return run_.number(); }  // 0: none
  // Reports whether no job runs, no abort leaves this host, and no internal error has to be recovered from.
  bool is_idle() const { return run_.number() == 0 && abort_.phase() != AbortPhase::leaves && internal_error_.empty(); }
  // Reports whether an abort is to be sent, or has not left this host.
  bool abort_waits() const { return abort_.waits() || !internal_error_.empty(); }
  MillLink link() const { return link_; }
  const std::optional<MeasuredPace>& measured_pace() const { return run_.measured_pace(); }
  const MillSettings& settings() const { return settings_; }
  // Returns SetupLeft::surfaces().
  std::uint64_t surfaces() const { return left_.surfaces(); }
  // Takes the events that a state machine of the mill does not have in its table: the mill is aborted, its line opened
  // again, and the job that runs is PAUSED_UNKNOWN.
  Violations& violations() { return *this; }
  // Text of the first invariant that does not hold; empty if all do.
  std::string broken_invariant() const;

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view, TimePoint) override {}  // a mill never answers (guideline 4-2)
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

  // Time between two attempts to open the line: the first, doubled each time up to the last.
  static constexpr Duration kReopenFirst = std::chrono::milliseconds(250), kReopenLast = std::chrono::seconds(5);

 private:
  // Passes on what is written, after it was noted.
  class NotedLine : public FlowLink {
   public:
    NotedLine(MillController& mill, FlowLink& line) : mill_(mill), line_(line) {}
    void write(std::string_view bytes) override;
    void reopen(Duration wait) override { line_.reopen(wait); }
    std::size_t unsent() const override { return line_.unsent(); }
    bool held() const override { return line_.held(); }
    void ignore_flow_control(bool ignored) override { line_.ignore_flow_control(ignored); }

   private:
    MillController& mill_;
    FlowLink& line_;
  };

  void illegal(std::string_view machine, std::string_view state, std::string_view event) override;
  Result<void> check_open() const;
  Result<void> check_no_job_runs(std::string_view hint) const;
  Result<void> check_startable(const Job& job, TimePoint now) const;
  void count_surface();
  bool send_abort(TimePoint now);
  void recover(TimePoint now);

  const MillSettings settings_;
  NotedLine line_;
  MillEvents& events_;
  Rights rights_;
  SetupLeft left_;
  JobQueue queue_;
  Confirmations confirmations_;
  Abort abort_;
  HandWork hand_;
  JobRun run_;
  MillLink link_ = MillLink::closed;
  Duration reopen_ = kReopenFirst;
  std::string internal_error_;  // that advance() has not recovered from yet; empty: none
  TimePoint now_{};             // of the last call of a LineMachine's functions
};

}  // namespace axisgate::rml1
