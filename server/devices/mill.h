// A mill: a device that is sent jobs and never answers. Its controller, and what others may see of its state.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "device/rml1/mill/mill_controller.h"
#include "server/config/config.h"
#include "server/devices/device.h"
#include "server/devices/job_record.h"
#include "server/devices/repeated_stops.h"
#include "server/events/event_bus.h"
#include "server/events/newest.h"
#include "server/events/wall_time.h"
#include "server/journal/journal.h"
#include "server/metrics/mill_metrics.h"
#include "server/spool/spool.h"

namespace boost::asio {
class thread_pool;
}

namespace axisgate::server {

struct MillNow {
  rml1::MillLink link = rml1::MillLink::closed;
  std::string why_closed;       // for people; empty: it is open, or was not opened yet
  std::vector<rml1::Job> jobs;  // as MillController::jobs()
  std::optional<rml1::RunningJob> running;
  std::optional<rml1::MeasuredPace> measured_pace;
  Moment clock;                    // by which its times are shown
  std::optional<rml1::Job> ended;  // the one that left the queue last
  std::uint64_t surfaces = 0;      // MillController::surfaces()
};

class Mill final : public Device, private rml1::MillEvents {
 public:
  using Controller = rml1::MillController;

  // `config`, `bus`, `metrics`, `thread`, `lease_tokens` and `spool` outlive this. `record` and `journal` may be null.
  Mill(const DeviceConfig& device, const MillConfig& config, const JobsConfig& jobs, std::unique_ptr<Line> line,
       LineThread& thread, EventBus& bus, Metrics& metrics, const Executor& readers, LeaseTokens& lease_tokens,
       spool::Spool& spool, std::unique_ptr<JobRecord> record, journal::Journal* journal);
  ~Mill() override;

  // From any thread.
  std::string_view kind_name() const override { return config_.kind; }
  const MillConfig& config() const { return config_; }
  Newest<MillNow>& newest() { return newest_; }
  spool::Spool& spool() const { return spool_; }
  // A job that came twice: it never was in the queue.
  void drop_spooled(rml1::JobNumber job);

  // Calls `then` once the spool has kept what became of the jobs up to now, so that a kill no longer undoes it; what
  // the disk refuses is in the log. On the strand; `then` is called on the spool's thread, at the latest while this is
  // destroyed.
  void when_kept(std::function<void()> then);

  // Runs the request on the device's strand, from any thread. After shutdown() `too_late` is called in its place.
  using Request = std::function<void(rml1::MillController&, TimePoint)>;
  void post(Request request, std::function<void()> too_late = {});

  // On the strand only.
  MillNow now(TimePoint at);

  // At once where nothing runs. As `at_exit` says, the job that runs is aborted, or runs on for kFinishLimit, and is
  // aborted then; so is one that is paused.
  void wind_down(std::function<void()> done) override;
  Duration wind_down_limit() const override;

  // The abort is a few dozen bytes; a line that takes none by then is closed with them.
  static constexpr Duration kAbortLimit = std::chrono::seconds(3);
  static constexpr Duration kFinishLimit = std::chrono::seconds(60);
  // A job that runs is published as often.
  static constexpr Duration kPublishPause = std::chrono::milliseconds(500);

 private:
  void link_changed(rml1::MillLink link, std::string_view why, TimePoint now) override;
  void job_changed(const rml1::Job& job, std::string_view by, std::string_view why, TimePoint now) override;
  void rank_changed(const rml1::Job& job) override { keep(job); }
  void surface_set(std::uint64_t surfaces) override;
  void internal_error(std::string_view what, TimePoint now) override;
  void sender_changed(const rml1::RunningJob& running, TimePoint now) override;
  void about_to_write(rml1::JobNumber job, const rml1::WrittenRange& sent) override;
  void written(std::string_view bytes, rml1::JobNumber job) override;
  void abort_requested(std::string_view by, TimePoint now) override;

  void restore_jobs();
  void plan_again(rml1::Job& job);
  void keep(const rml1::Job& job);
  void plan_rest(const rml1::Job& job);
  void note(const rml1::Job& job, std::string_view by, std::string_view why, TimePoint now);
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
  rml1::MillController controller_;
  RepeatedStops repeated_stops_;
  bool changed_ = true;                     // since publish()
  std::optional<stage::LinkChanged> link_;  // a line that stays closed is tried again and again
  std::optional<rml1::Job> ended_;          // as MillNow::ended
  std::uint64_t writes_ = 0;                // recorded, each by itself
  TimePoint published_{};
  TimePoint abort_at_{};              // while the daemon ends: the job has run for long enough
  std::function<void()> wound_down_;  // empty: nobody waits
  const std::unique_ptr<boost::asio::thread_pool> spool_thread_;  // one thread; last: its tasks use the spool
};

}  // namespace axisgate::server
