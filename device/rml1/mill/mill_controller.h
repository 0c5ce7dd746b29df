// Controller of one mill: connects its queue, confirmations, running job, abort and acts by hand to a line.
// device/jobs/README.md explains the states of a job.
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
#include "device/jobs/confirmations.h"
#include "device/jobs/job.h"
#include "device/jobs/job_queue.h"
#include "device/jobs/machine.h"
#include "device/jobs/rights.h"
#include "device/jobs/send_settings.h"
#include "device/jobs/setup_left.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/mill/by_hand.h"
#include "device/rml1/mill/hand_work.h"
#include "device/rml1/mill/job_run.h"
#include "device/rml1/mill/prepared_job.h"
#include "device/rml1/sending/abort.h"
#include "device/use/permission.h"
#include "device/use/request_context.h"

namespace axisgate::rml1 {

// Not thread safe: used only on its device's strand.
class MillController : public jobs::Machine, private Violations {
 public:
  // The referenced objects must outlive this one.
  MillController(const Profile& profile, const jobs::MachineSettings& settings, FlowLink& line,
                 jobs::MachineEvents& events, use::Permission& permission);

  void inherit(jobs::Job job) override;
  void inherit_left(const jobs::Job& last) override;
  void inherit_abort() override { abort_.postpone(); }
  void inherit_z0_count(std::uint64_t z0_count) override { left_.inherit_z0_count(z0_count); }

  void add(jobs::Job job, TimePoint now) override { queue_.add(std::move(job), now); }
  Result<void> confirm(jobs::JobNumber job, const jobs::JobSetup& seen, std::string by, TimePoint now) override;
  Result<void> check_startable(jobs::JobNumber job, TimePoint now) override;
  // `prepared` must be an rml1::PreparedJob.
  Result<void> start(jobs::JobNumber job, std::shared_ptr<const jobs::PreparedJob> prepared,
                     const use::RequestContext& by, TimePoint now) override;
  Result<void> pause(bool raise, TimePoint now) override { return run_.pause(raise, now); }
  Result<void> resume(const use::RequestContext& by, TimePoint now) override;
  Result<void> choose_rest(jobs::JobNumber job, const jobs::JobRest& rest, std::string_view by, TimePoint now) override;
  void plan_rest(const jobs::Job& planned) override;
  bool abort(const use::RequestContext& by, TimePoint now) override;
  bool abort(std::string_view by, TimePoint now) override;
  Result<void> cancel(jobs::JobNumber job, std::string_view by, TimePoint now) override;
  Result<void> done(jobs::JobNumber job, std::string_view by, TimePoint now) override;
  Result<void> move_first(jobs::JobNumber job, jobs::Overtaken overtaken, std::string_view by, TimePoint now) override {
    return queue_.move_first(job, overtaken, by, now);
  }
  Result<Duration> operate(const jobs::HandAct& act, const use::RequestContext& by, TimePoint now) override;

  const std::vector<jobs::Job>& jobs() const override { return queue_.jobs(); }
  std::optional<jobs::RunningJob> running(TimePoint now) override { return run_.view(now); }
  jobs::JobNumber running_job() const override { return run_.number(); }
  bool is_idle() const override {
    return run_.number() == 0 && abort_.phase() != AbortPhase::leaves && internal_error_.empty();
  }
  bool abort_waits() const override { return abort_.waits() || !internal_error_.empty(); }
  jobs::MachineLink link() const override { return link_; }
  const std::optional<jobs::MeasuredPace>& measured_pace() const override { return run_.measured_pace(); }
  std::uint64_t z0_count() const override { return left_.z0_count(); }
  // Voids the confirmation, if there is one. `why`: reason, for people.
  void setup_changed(std::string_view why, TimePoint now) { confirmations_.make_void(why, now); }
  // Receives reports of events that the table of a state machine does not allow. After such an event, the mill is
  // aborted, its line is reopened, and the running job is PAUSED_UNKNOWN.
  Violations& violations() { return *this; }
  // Text of the first invariant that does not hold; empty if all do.
  std::string broken_invariant() const;

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view, TimePoint) override {}  // a mill never answers (guideline 4-2)
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

  // Time before the line is opened again: kReopenFirst, doubled after each failure, at most kReopenLast.
  static constexpr Duration kReopenFirst = std::chrono::milliseconds(250), kReopenLast = std::chrono::seconds(5);

 private:
  // A NotedLine reports bytes to the running job before it writes them, and to the events after it has written them.
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
  Result<void> check_startable(const jobs::Job& job, TimePoint now) const;
  void count_surface();
  bool send_abort(TimePoint now);
  void recover(TimePoint now);

  const jobs::MachineSettings settings_;
  NotedLine line_;
  jobs::MachineEvents& events_;
  jobs::Rights rights_;
  jobs::SetupLeft left_;
  jobs::JobQueue queue_;
  jobs::Confirmations confirmations_;
  Abort abort_;
  HandWork hand_;
  JobRun run_;
  jobs::MachineLink link_ = jobs::MachineLink::closed;
  Duration reopen_ = kReopenFirst;
  std::string internal_error_;  // text of an error from which advance() has not recovered yet; empty: none
  TimePoint now_{};             // time of the last call of link_up(), link_down() or advance()
};

}  // namespace axisgate::rml1
