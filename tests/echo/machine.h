// The controller of an echo machine: one line of a job at a time. Queue and confirmations are those of device/jobs.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "device/core/violations.h"
#include "device/jobs/confirmations.h"
#include "device/jobs/machine.h"
#include "device/jobs/rights.h"
#include "device/jobs/setup_left.h"
#include "tests/echo/model.h"

namespace axisgate::echo {

class EchoMachine final : public jobs::Machine, private Violations {
 public:
  EchoMachine(const jobs::MachineSettings& settings, FlowLink& line, jobs::MachineEvents& events,
              use::Permission& permission);

  void inherit(jobs::Job job) override { queue_.inherit(std::move(job)); }
  void inherit_left(const jobs::Job& last) override { left_.inherit(last); }
  void inherit_abort() override { abort_waits_ = true; }
  void inherit_z0_count(std::uint64_t) override {}

  void add(jobs::Job job, TimePoint now) override { queue_.add(std::move(job), now); }
  Result<void> confirm(jobs::JobNumber job, const jobs::JobSetup& seen, std::string by, TimePoint now) override;
  Result<void> check_startable(jobs::JobNumber job, TimePoint now) override;
  Result<void> start(jobs::JobNumber job, std::shared_ptr<const jobs::PreparedJob> prepared,
                     const use::RequestContext& by, TimePoint now) override;
  Result<void> pause(bool raise, TimePoint now) override;
  Result<void> resume(const use::RequestContext& by, TimePoint now) override;
  Result<void> choose_rest(jobs::JobNumber job, const jobs::JobRest& rest, std::string_view by, TimePoint now) override;
  void plan_rest(const jobs::Job&) override {}
  bool abort(const use::RequestContext& by, TimePoint now) override;
  bool abort(std::string_view by, TimePoint now) override;
  Result<void> cancel(jobs::JobNumber job, std::string_view by, TimePoint now) override;
  Result<void> done(jobs::JobNumber job, std::string_view by, TimePoint now) override;
  Result<void> move_first(jobs::JobNumber job, jobs::Overtaken overtaken, std::string_view by, TimePoint now) override {
    return queue_.move_first(job, overtaken, by, now);
  }
  Result<Duration> operate(const jobs::HandAct& act, const use::RequestContext& by, TimePoint now) override;

  const std::vector<jobs::Job>& jobs() const override { return queue_.jobs(); }
  std::optional<jobs::RunningJob> running(TimePoint now) override;
  jobs::JobNumber running_job() const override { return run_ ? run_->number : 0; }
  bool is_idle() const override { return !run_ && !abort_waits_; }
  bool abort_waits() const override { return abort_waits_; }
  jobs::MachineLink link() const override { return link_; }
  const std::optional<jobs::MeasuredPace>& measured_pace() const override { return pace_; }
  std::uint64_t z0_count() const override { return 0; }

  void link_up(TimePoint now) override;
  void link_down(TimePoint now, std::string_view why) override;
  void receive(std::string_view bytes, TimePoint now) override;
  void advance(TimePoint now) override;
  std::optional<TimePoint> next_deadline() const override;

 private:
  struct Run {
    jobs::JobNumber number = 0;
    std::shared_ptr<const PreparedText> text;
    std::size_t sent = 0, answered = 0;  // lines
    std::uint64_t from = 0;              // byte of the job
    TimePoint started{};
    bool paused = false;
  };

  void illegal(std::string_view machine, std::string_view state, std::string_view event) override;
  Result<void> check_open() const;
  jobs::RunningJob view() const;
  std::uint64_t byte_after(std::size_t lines) const;
  void send_next(TimePoint now);
  void end(jobs::JobEvent event, std::string_view by, std::string_view why, TimePoint now);
  void write(std::string_view bytes);

  FlowLink& line_;
  jobs::MachineEvents& events_;
  jobs::Rights rights_;
  jobs::SetupLeft left_;
  jobs::JobQueue queue_;
  jobs::Confirmations confirmations_;
  std::optional<Run> run_;
  std::string received_;
  jobs::MachineLink link_ = jobs::MachineLink::closed;
  bool abort_waits_ = false;
  std::optional<jobs::MeasuredPace> pace_;
};

}  // namespace axisgate::echo
