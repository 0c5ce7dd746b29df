// One mill: its queue, its confirmation, and the job that runs. README.md says what each state means.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/core/line_machine.h"
#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/core/violations.h"
#include "device/rml1/mill/by_hand.h"
#include "device/rml1/mill/job.h"
#include "device/rml1/mill/job_queue.h"
#include "device/rml1/mill/prepared_job.h"
#include "device/rml1/profile.h"
#include "device/rml1/sending/abort.h"
#include "device/rml1/sending/sender.h"
#include "device/stage/permission.h"
#include "device/stage/requests.h"

namespace axisgate::rml1 {

struct MillSettings {
  SendSettings sending;
  Duration confirmation_lasts = std::chrono::minutes(10);
  Duration busy_limit = std::chrono::minutes(10);  // so long without a byte taken, and the mill is said to be busy
  AtLoss at_loss = AtLoss::abort;
  Duration queued_at_most = std::chrono::days(14);  // a job that nobody has confirmed by then ends EXPIRED
};

enum class MillLink { closed, open };

// The job that runs.
struct RunningJob {
  JobNumber number = 0;
  SenderState sender = SenderState::ready;
  SendProgress progress;  // in bytes of the job itself
  RunOn run_on;
  TimeRange left;  // of the job, as takes() counts
  TimePoint started{};
  bool busy = false;  // for MillSettings::busy_limit the mill has taken nothing
};

// JobRest is the place where a job continues, with the time that its part then takes.
struct JobRest {
  Place from;
  TimeRange takes{};
  RunOn run_on{};
};

// What others see of what happens. Called from within the controller's members; must not call back.
class MillEvents : public QueueEvents {
 public:
  virtual void link_changed(MillLink link, std::string_view why, TimePoint now) = 0;
  // Called whenever Z0 is sent. The new surfaces() outlives the daemon.
  virtual void surface_set(std::uint64_t surfaces) = 0;
  virtual void sender_changed(const RunningJob& running, TimePoint now) = 0;
  // Bytes of the job up to sent.most go to the line next, and the mill has those up to sent.least. What must outlive a
  // killed daemon is kept before it returns.
  virtual void about_to_write(JobNumber job, const WrittenRange& sent) = 0;
  // These bytes were given to the line, for a job or, with 0, for none.
  virtual void written(std::string_view bytes, JobNumber job) = 0;
  // Also where no job runs.
  virtual void abort_requested(std::string_view by, TimePoint now) = 0;
  // A state machine of the mill had an event that its table does not have: an error of the gateway's own.
  virtual void internal_error(std::string_view what, TimePoint now) = 0;
};

// Not thread safe: lives on its device's strand. Where a request is refused nothing has changed.
class MillController : public LineMachine, private Violations {
 public:
  // All outlive this.
  MillController(const Profile& profile, const MillSettings& settings, FlowLink& line, MillEvents& events,
                 stage::Permission& permission);

  // A job of the run of the daemon before this one: QUEUED, TOOL_CHANGE, PAUSED, FED, or PAUSED_UNKNOWN with what is
  // known to be `written`; with its queued_since. It has the place that is_before() gives it. Before link_up().
  void inherit(Job job);
  // The job that was begun last in the runs before, whatever has become of it. Before link_up().
  void inherit_left(const Job& last);
  // An abort that the run before could not send any more. Before link_up().
  void inherit_abort() { abort_.postpone(); }
  // surfaces() of the run before. Before link_up().
  void inherit_surfaces(std::uint64_t surfaces) { surfaces_ = surfaces; }
  // Puts the job after all others. The numbers ascend. With JobSetup::from it is the rest of another job. Otherwise,
  // with Job::continues, Job::surfaces is the surfaces() with which its heights count.
  void add(Job job, TimePoint now);
  // By somebody at the mill. not_found; wrong_mode: it is not the next one, another one runs, or what
  // became of the last one is not known; link_down;
  // stale_setpoint: `seen` is not what the job needs, or not what the one before has left.
  Result<void> confirm(JobNumber job, const JobSetup& seen, std::string by, TimePoint now);
  // What start() refuses, as far as it needs neither the bytes nor the right to the mill: not_found; wrong_mode;
  // not_allowed, where it is not confirmed any more; link_down.
  Result<void> check_startable(JobNumber job, TimePoint now);
  // Its first byte goes out, if the mill takes it. `prepared` is of the bytes of its next part. What check_startable()
  // and Permission::authorize() refuse.
  Result<void> start(JobNumber job, std::shared_ptr<const PreparedJob> prepared, const stage::RequestContext& by,
                     TimePoint now);
  // Of the running job; wrong_mode where none runs, or not so. `raise`: behind what was sent the tool is raised and the
  // spindle stops, and the job is then PAUSED.
  Result<void> pause(bool raise, TimePoint now);
  // Also what Permission::authorize() refuses.
  Result<void> resume(const stage::RequestContext& by, TimePoint now);
  // Of a job that is PAUSED_UNKNOWN or PAUSED: it continues at that place of its part, when it is confirmed and
  // started. not_found; wrong_mode.
  Result<void> choose_rest(JobNumber job, const JobRest& rest, std::string_view by, TimePoint now);
  // Nothing of the job is written after it. Where none runs the mill is sent the abort all the same. False: the line is
  // closed, and it is sent when the line is back. Nobody whose job it ends, or whose lease it concerns, may start
  // another one before they rearm.
  bool abort(const stage::RequestContext& by, TimePoint now);
  // The same without that, by what ends the job and is no stop.
  bool abort(std::string_view by, TimePoint now);
  // not_found; wrong_mode, where the job's state does not have it.
  Result<void> cancel(JobNumber job, std::string_view by, TimePoint now);
  Result<void> done(JobNumber job, std::string_view by, TimePoint now);
  // Takes the place of the first QUEUED one of those that it may be before; each of these takes that of the next one.
  // The places of all others stay. not_found; wrong_mode: it is not QUEUED.
  Result<void> move_first(JobNumber job, Overtaken overtaken, std::string_view by, TimePoint now);
  // While no job runs. What was confirmed is void. The answer: after that time it is done, with all that was sent
  // before; until then no job is started, and no other step. wrong_mode; link_down; axis_busy: the mill takes nothing,
  // or the step before may not be done; what Permission::authorize() and words_of() refuse.
  Result<Duration> operate(const HandAct& act, const stage::RequestContext& by, TimePoint now);
  // Takes over the plan of a rest that was computed off the strand, if the job still continues there.
  void plan_rest(const Job& planned);
  // What was confirmed is not so any more. `why`: for people.
  void setup_changed(std::string_view why, TimePoint now);

  // Those without an end, in the order of the queue; the one that runs is among them.
  const std::vector<Job>& jobs() const { return jobs_; }
  std::optional<RunningJob> running(TimePoint now);
  JobNumber running_job() const { return running_ ? running_->number : 0; }
  // Reports whether no job runs, and no abort leaves this host.
  bool is_idle() const { return !running_ && abort_.phase() != AbortPhase::leaves; }
  // Reports whether an abort is to be sent, or has not left this host.
  bool abort_waits() const { return abort_.waits(); }
  MillLink link() const { return link_; }
  // By the last job that could show it, since this began.
  const std::optional<MeasuredPace>& measured_pace() const { return measured_pace_; }
  const MillSettings& settings() const { return settings_; }
  // Counts how often Z0 was sent, by hand or by a job. Z0 set at the panel is not counted: nobody sees it.
  std::uint64_t surfaces() const { return surfaces_; }
  // Where the mill's state machines report an event that their table does not have: the mill is aborted, its line
  // opened again, and the job that runs is PAUSED_UNKNOWN.
  Violations& violations() { return *this; }
  // Text of the first invariant that does not hold; empty if all do.
  std::string broken_invariant() const;

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view, TimePoint) override {}  // a mill never answers (guideline 4-2)
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

  // Between two attempts to open the line: the first, doubled each time up to the last.
  static constexpr Duration kReopenFirst = std::chrono::milliseconds(250), kReopenLast = std::chrono::seconds(5);

  // At a job that runs, so that others see its progress.
  static constexpr Duration kLook = std::chrono::milliseconds(500);

 private:
  // Passes on what is written, behind the note of it.
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
  struct Running {
    JobNumber number;
    std::shared_ptr<const PreparedJob> prepared;
    TimePoint started;
    Sender sender;
    SenderState seen = SenderState::ready;
    std::uint64_t noted = 0;  // bytes of the text that were given to the line
    std::uint64_t left = 0;   // bytes of it that have left the host, at `left_at`
    TimePoint left_at{};
    bool busy = false;
    std::string aborted_by;
  };

  Result<void> authorize(const stage::RequestContext& by, JobNumber job, TimePoint now);
  void follow_leases(TimePoint now);

  Result<Job*> find(JobNumber number);
  Result<void> change(JobNumber number, JobEvent event, std::string_view by, TimePoint now);
  void change(Job& job, JobEvent event, std::string_view by, std::string_view why, TimePoint now);
  void leave_queue_if_ended(JobNumber number);
  Result<void> check_free() const;
  Result<void> check_taken() const;
  Result<void> check_still(TimePoint now) const;
  Result<void> check_risen(TimePoint now) const;
  Result<void> check_operable(const HandAct& act, TimePoint now) const;
  void show_left();
  void rank_as_ordered();
  Result<void> check_settled() const;
  Result<void> check_next(const Job& job) const;
  Result<void> check_surface(const Job& job) const;
  Result<void> check_sending(bool raise) const;
  Result<void> check_pausable(bool raise, TimePoint now);
  Result<void> check_startable(const Job& job, TimePoint now) const;
  bool send_abort(TimePoint now);
  void note_executed(TimePoint now);
  void illegal(std::string_view machine, std::string_view state, std::string_view event) override;
  void recover(TimePoint now);
  void look_at_sender(TimePoint now);
  void end_aborted(TimePoint now);
  void set_surfaces(std::uint64_t surfaces);
  void look_whether_busy(TimePoint now);
  void end_fed_part(TimePoint now);
  void end_raised(TimePoint now);
  std::uint64_t in_mill(std::uint64_t left) const;
  WrittenRange written_at_loss();
  void end_run(JobEvent event, std::string_view by, std::string_view why, TimePoint now);
  RunningJob view(TimePoint now);
  std::optional<TimePoint> confirmed_until() const;
  void expire_jobs(TimePoint now);
  std::optional<TimePoint> next_expiry() const;

  const Profile& profile_;
  const MillSettings settings_;
  FlowLink& line_;
  NotedLine noted_line_;
  MillEvents& events_;
  stage::Permission& permission_;
  MillLink link_ = MillLink::closed;
  Duration reopen_ = kReopenFirst;
  std::vector<Job> jobs_;
  Job last_;  // the job that was started last: its number, name, and what it leaves
  std::uint64_t surfaces_ = 0;
  std::unique_ptr<Running> running_;
  std::optional<MeasuredPace> measured_pace_;
  Abort abort_;
  std::string internal_error_;  // that advance() has not recovered from yet; empty: none
  TimePoint by_hand_until_{};   // what a person does with it ends, at the latest
  TimePoint rises_until_{};     // the tool, after an abort that the mill obeys at once
  TimePoint now_{};             // of the last call
};

}  // namespace axisgate::rml1
