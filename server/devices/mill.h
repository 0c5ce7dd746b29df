// A mill is a device that receives jobs and never answers. This file has its controller and its published state.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/jobs/machine.h"
#include "server/config/config.h"
#include "server/devices/device.h"
#include "server/devices/job_record.h"
#include "server/devices/repeated_stops.h"
#include "server/events/event_bus.h"
#include "server/events/newest.h"
#include "server/events/wall_time.h"
#include "server/journal/journal.h"
#include "server/limits.h"
#include "server/metrics/mill_metrics.h"
#include "server/spool/spool.h"

namespace boost::asio {
class thread_pool;
}

namespace axisgate::server {

struct MillNow {
  jobs::MachineLink link = jobs::MachineLink::closed;
  std::string why_closed;       // text for people; empty: the line is open, or was never opened
  std::vector<jobs::Job> jobs;  // value of Machine::jobs()
  std::optional<jobs::RunningJob> running;
  std::optional<jobs::MeasuredPace> measured_pace;
  Moment clock;                    // clock by which the times are shown
  std::optional<jobs::Job> ended;  // job that left the queue last
  std::uint64_t z0_count = 0;      // value of Machine::z0_count()
};

class Mill final : public Device, private jobs::MachineEvents {
 public:
  using Controller = jobs::Machine;

  // `config`, `bus`, `metrics`, `thread`, `lease_tokens` and `spool` must outlive the mill. `record` and `journal` may
  // be null.
  Mill(const DeviceConfig& device, const MillConfig& config, const JobsConfig& jobs, std::unique_ptr<Line> line,
       LineThread& thread, EventBus& bus, Metrics& metrics, const Executor& readers, LeaseTokens& lease_tokens,
       spool::Spool& spool, std::unique_ptr<JobRecord> record, journal::Journal* journal);
  ~Mill() override;

  // These members may be called from any thread.
  std::string_view kind_name() const override { return config_.kind->name(); }
  use::Scope whole() const override { return use::Scope::whole_device(); }
  const MillConfig& config() const { return config_; }
  Newest<MillNow>& newest() { return newest_; }
  spool::Spool& spool() const { return spool_; }
  // Drops a job that was sent twice and never was in the queue.
  void drop_spooled(jobs::JobNumber job);

  // Calls `then` once the spool has kept all changes of jobs up to now, so that killing the daemon cannot undo them.
  // Failures of the disk are logged. Call it on the strand; `then` runs on the spool's thread, at the latest while the
  // mill is destroyed.
  void when_kept(std::function<void()> then);

  // Runs the request on the device's strand. After shutdown() `too_late` is called instead. May be called from any
  // thread.
  using Request = std::function<void(jobs::Machine&, TimePoint)>;
  void post(Request request, std::function<void()> too_late = {});

  // Call on the strand only.
  MillNow now(TimePoint at);

  // Ends at once if no job is running. Depending on `at_exit`, a running job is aborted at once or after
  // kJobFinishLimit. A paused job is aborted at once.
  void wind_down(std::function<void()> done) override;
  Duration wind_down_limit() const override;

 private:
  void link_changed(jobs::MachineLink link, std::string_view why, TimePoint now) override;
  void job_changed(const jobs::Job& job, std::string_view by, std::string_view why, TimePoint now) override;
  void rank_changed(const jobs::Job& job) override { keep(job); }
  void z0_sent(std::uint64_t z0_count) override;
  void internal_error(std::string_view what, TimePoint now) override;
  void sender_changed(const jobs::RunningJob& running, TimePoint now) override;
  void about_to_write(jobs::JobNumber job, const jobs::WrittenRange& sent) override;
  void written(std::string_view bytes, jobs::JobNumber job) override;
  void abort_requested(std::string_view by, TimePoint now) override;

  void restore_jobs();
  void plan_again(jobs::Job& job);
  void keep(const jobs::Job& job);
  void plan_rest(const jobs::Job& job);
  void note(const jobs::Job& job, std::string_view by, std::string_view why, TimePoint now);
  void publish_fact(Fact fact, TimePoint now);
  void after_call();
  void publish(TimePoint at);
  void look_whether_wound_down(TimePoint now);

  const MillConfig& config_;
  EventBus& bus_;
  spool::Spool& spool_;
  const std::unique_ptr<JobRecord> record_;
  journal::Journal* const journal_;
  Newest<MillNow> newest_;
  MillMetrics metrics_;
  const std::unique_ptr<jobs::Machine> controller_;
  RepeatedStops repeated_stops_;
  bool changed_ = true;                     // since publish()
  std::optional<stage::LinkChanged> link_;  // connecting to a line that stays closed is tried again and again
  std::optional<jobs::Job> ended_;          // value of MillNow::ended
  std::uint64_t writes_ = 0;                // number of recorded writes
  TimePoint published_{};
  TimePoint abort_at_{};              // end of the time that a job may still run while the daemon ends
  std::function<void()> wound_down_;  // empty if nobody waits
  // One thread; last member, because its tasks use the spool.
  const std::unique_ptr<boost::asio::thread_pool> spool_thread_;
};

}  // namespace axisgate::server
