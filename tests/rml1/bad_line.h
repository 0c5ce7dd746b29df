// Test bench of a mill and its controller with a bad line between them, in virtual time. One seed is one run.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/mill/mill_controller.h"
#include "tests/rml1/executed_job.h"
#include "tests/rml1/fake_permission.h"
#include "tests/rml1/faulty_line.h"
#include "tests/rml1/line_fault_plan.h"
#include "tests/rml1/simulator_bench.h"

namespace axisgate::rml1 {

struct LineFaultRun {
  std::optional<std::string> violation;             // the first violated requirement
  std::string replay;                               // the drawn choices and the last events
  jobs::JobState outcome = jobs::JobState::queued;  // outcome of the job
  // Faults that occurred.
  bool byte_changed = false, stuck = false, xon_lost = false, line_broke = false, was_busy = false;
  std::size_t ran_on = 0;  // bytes, after an abort of the job
};

// A BadLine has two jobs in its queue. It confirms and sends the first, and then settles its outcome.
class BadLine : private jobs::MachineEvents {
 public:
  explicit BadLine(std::uint64_t seed);
  LineFaultRun run();  // call once

 private:
  void before_start();
  void start();
  void run_job();
  void expect_end();
  void expect_busy_and_abort();
  void expect_fed_is_true();
  void expect_progress_is_true();
  void expect_little_ran_on();
  void expect_range_holds();
  void expect_next_waits();

  void act(Act::Kind kind);
  void abort();
  void break_line();
  void bring_line_back();
  Result<void> confirm(jobs::JobNumber number);
  void expect_refused(const Result<void>& result, Reason reason, std::string_view what);
  void expect_not_startable(std::string_view why);

  bool step_of_job(TimePoint until);
  bool step(TimePoint until);
  void run_for(Duration time);
  void deliver(char byte);
  void give_to_mill(char byte, std::uint64_t through);
  void read_record();
  void writes(std::string_view bytes);
  void writes_of_job(std::string_view bytes);

  bool runs() const { return mill_.running_job() != 0; }
  // Reports a fault that cannot be detected: a changed byte, or a lost XON while bytes wait in a converter.
  bool is_hidden() const { return result_.byte_changed || (line_.has_lost_xon() && plan_.line.converter > 0); }
  jobs::JobState state() const { return states_.at(kFirst); }
  void violate(std::string what);
  void note(std::string what);

  void link_changed(jobs::MachineLink link, std::string_view, TimePoint) override;
  void job_changed(const jobs::Job& job, std::string_view by, std::string_view why, TimePoint) override;
  void rank_changed(const jobs::Job&) override {}
  void z0_sent(std::uint64_t) override {}
  void internal_error(std::string_view what, TimePoint) override { violate(std::string(what)); }
  void sender_changed(const jobs::RunningJob& running, TimePoint) override;
  void written(std::string_view, jobs::JobNumber) override {}
  void abort_requested(std::string_view, TimePoint) override {}
  void about_to_write(jobs::JobNumber, const jobs::WrittenRange& sent) override { noted_ = sent.most; }

  static constexpr jobs::JobNumber kFirst = 1, kSecond = 2;
  static inline const use::RequestContext kOwner{.who = "unix anna"}, kAtMill{.who = "unix bert"};

  const std::uint64_t seed_;
  const Profile profile_ = test_profile();
  const LineFaultPlan plan_;
  const std::shared_ptr<const PreparedJob> prepared_;
  const std::string_view text_;
  simulator::MillBench bench_;
  FaultyLine line_;
  FakePermission permission_;
  MillController mill_;
  ExecutedJob executed_;

  std::map<jobs::JobNumber, jobs::JobState> states_;
  std::deque<std::uint64_t>
      in_transit_;  // for each byte on the line, the number of text bytes up to it; 0: not part of the text
  std::uint64_t job_written_ = 0, noted_ = 0, job_arrived_ = 0;       // bytes; the first and the last of the text
  std::uint64_t taken_ = 0;                                           // bytes of the job, last reported
  std::size_t lines_read_ = 0, abort_writes_ = 0, without_time_ = 0;  // without_time_: steps
  bool aborted_ = false;                                              // while the job ran
  bool abort_outstanding_ = false;                                    // requested while the line was closed
  bool abort_requested_ = false;
  bool fed_looked_at_ = false;
  std::uint64_t executed_at_abort_ = 0;
  jobs::RunOn bound_{};
  std::optional<jobs::WrittenRange> range_;
  std::vector<std::string> happened_;
  LineFaultRun result_;
};

}  // namespace axisgate::rml1
