// The running job, from the first byte of its part until this part is executed, paused with the tool up, aborted or
// lost.
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

// A JobRun runs the jobs of one mill, at most one at a time. Not thread safe.
class JobRun {
 public:
  struct Limits {
    std::size_t converter = 0;  // bytes that a converter between host and mill can contain
    Duration busy{};            // a mill that takes no byte for this time is busy
  };

  // The referenced objects must outlive this one.
  JobRun(const Profile& profile, const Limits& limits, const MillLine& mill, jobs::JobQueue& queue,
         jobs::Rights& rights, jobs::RunEvents& events)
      : profile_(profile), limits_(limits), mill_(mill), queue_(queue), rights_(rights), events_(events) {}

  // Number of the running job; 0 if no job runs.
  jobs::JobNumber number() const { return run_ ? run_->number : 0; }
  // State of the running job; nullopt if no job runs.
  std::optional<jobs::RunningJob> view(TimePoint now);
  // Pace of the mill, from the last job that could measure it; nullopt if no job could.
  const std::optional<jobs::MeasuredPace>& measured_pace() const { return measured_pace_; }

  // Starts a confirmed job; no job may be running. Sends the first byte at once if the mill takes it.
  void start(jobs::Job& job, std::shared_ptr<const PreparedJob> prepared, const use::RequestContext& by, TimePoint now);
  // Pauses the running job. If `raise`, the tool is raised and the spindle stops after the bytes sent before, and the
  // job is then PAUSED. Fails with wrong_job_state if no job is being sent, if the job is already paused, or if its
  // last byte was written.
  Result<void> pause(bool raise, TimePoint now);
  // Fails with wrong_job_state if no job is paused with the tool in the cut.
  Result<void> check_resumable() const;
  // Continues sending. Call it after check_resumable() has passed.
  void resume(TimePoint now);
  // Stops sending the running job and writes the abort. A job must be running.
  void abort(std::string_view by, TimePoint now);
  // Makes the running job, if there is one, PAUSED_UNKNOWN. `why`: reason, for people.
  void line_lost(std::string_view why, TimePoint now);
  // Makes the running job, if there is one, PAUSED_UNKNOWN after an internal error, whatever its state is.
  void abandon(std::string_view why, TimePoint now);

  // Notes that `bytes` bytes will be written next. `unsent`: number of bytes written before that are still in the host.
  void about_to_write(std::size_t bytes, std::size_t unsent);

  void advance(TimePoint now);
  std::optional<TimePoint> next_deadline(TimePoint now) const;

  std::string broken_invariant() const;

  // Longest time between two calls of advance(), so that the displayed progress stays current.
  static constexpr Duration kLook = std::chrono::milliseconds(500);

 private:
  struct Run {
    jobs::JobNumber number;
    std::shared_ptr<const PreparedJob> prepared;
    TimePoint started;
    Sender sender;
    jobs::SenderState seen = jobs::SenderState::ready;
    std::uint64_t noted = 0;  // number of bytes of PreparedJob::text() that were given to the line
    std::uint64_t left = 0;   // number of bytes of the text that have left the host
    TimePoint left_at{};      // last time at which `left` changed or no byte waited
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
