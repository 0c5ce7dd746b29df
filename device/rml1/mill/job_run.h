// The job that runs: from its first byte until its part is executed, paused, aborted or lost.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "device/core/problem.h"
#include "device/core/time.h"
#include "device/jobs/job_queue.h"
#include "device/jobs/rights.h"
#include "device/jobs/running_job.h"
#include "device/rml1/machine/profile.h"
#include "device/rml1/mill/prepared_job.h"
#include "device/rml1/sending/sender.h"

namespace axisgate::rml1 {

// Not thread safe.
class JobRun {
 public:
  struct Limits {
    std::size_t converter = 0;  // bytes between host and mill
    Duration busy{};            // time without a byte taken after which the mill is busy
  };

  // The referenced objects must outlive this one.
  JobRun(const Profile& profile, const Limits& limits, const MillLine& mill, jobs::JobQueue& queue,
         jobs::Rights& rights, jobs::RunEvents& events)
      : profile_(profile), limits_(limits), mill_(mill), queue_(queue), rights_(rights), events_(events) {}

  // 0: no job runs.
  jobs::JobNumber number() const { return run_ ? run_->number : 0; }
  // nullopt if no job runs.
  std::optional<jobs::RunningJob> view(TimePoint now);
  // Pace of the mill by the last job that could show it; nullopt if none has.
  const std::optional<jobs::MeasuredPace>& measured_pace() const { return measured_pace_; }

  // Starts a confirmed job while none runs: its first byte goes out if the mill takes it.
  void start(jobs::Job& job, std::shared_ptr<const PreparedJob> prepared, const use::RequestContext& by, TimePoint now);
  // Fails with wrong_mode if no job is being sent. `raise`: after what was sent, the tool is raised and the spindle
  // stops, and the job is then PAUSED.
  Result<void> pause(bool raise, TimePoint now);
  // Fails with wrong_mode if no job is paused with the tool in the cut.
  Result<void> check_resumable() const;
  void resume(TimePoint now);
  // Writes nothing more of the job.
  void abort(std::string_view by, TimePoint now);
  // The job, if one runs, is PAUSED_UNKNOWN. `why`: for people.
  void line_lost(std::string_view why, TimePoint now);
  // Ends the job in the same way after an internal error, whatever its state.
  void abandon(std::string_view why, TimePoint now);

  // Called before so many bytes are written, while the host still has `unsent` ones.
  void about_to_write(std::size_t bytes, std::size_t unsent);

  void advance(TimePoint now);
  std::optional<TimePoint> next_deadline(TimePoint now) const;

  std::string broken_invariant() const;

  // Longest time between two calls of advance(), so that others see the progress.
  static constexpr Duration kLook = std::chrono::milliseconds(500);

 private:
  struct Run {
    jobs::JobNumber number;
    std::shared_ptr<const PreparedJob> prepared;
    TimePoint started;
    Sender sender;
    jobs::SenderState seen = jobs::SenderState::ready;
    std::uint64_t noted = 0;  // bytes of the text that were given to the line
    std::uint64_t left = 0;   // bytes of it that have left the host, at `left_at`
    TimePoint left_at{};
    bool busy = false;
    std::string aborted_by{};
  };

  jobs::Job& job() { return queue_.at(run_->number); }
  const PreparedJob& prepared() const { return *run_->prepared; }
  Result<void> check_sending(bool raise) const;
  Result<void> check_pausable(bool raise, TimePoint now);
  jobs::RunningJob view_of_run(TimePoint now);
  std::uint64_t in_mill(std::uint64_t left) const;
  jobs::WrittenRange written_at_loss() const;
  void note_executed(TimePoint now);
  void follow_sender(TimePoint now);
  void judge_busy(TimePoint now);
  void end_fed_part(TimePoint now);
  void end_raised(TimePoint now);
  void end_aborted(TimePoint now);
  void end(jobs::JobEvent event, std::string_view by, std::string_view why, TimePoint now);

  const Profile& profile_;
  const Limits limits_;
  const MillLine mill_;
  jobs::JobQueue& queue_;
  jobs::Rights& rights_;
  jobs::RunEvents& events_;
  std::unique_ptr<Run> run_;
  std::optional<jobs::MeasuredPace> measured_pace_;
};

}  // namespace axisgate::rml1
