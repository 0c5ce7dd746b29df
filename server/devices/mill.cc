#include "server/devices/mill.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <utility>

#include "device/core/explain.h"
#include "device/link/clock.h"
#include "server/devices/spooled_jobs.h"
#include "server/journal/job_entries.h"
#include "server/log.h"

namespace axisgate::server {
namespace {

jobs::MachineSettings settings_of(const MillConfig& config, const JobsConfig& jobs) {
  return {.sending = config.sending,
          .confirmation_lasts = config.confirmation,
          .busy_limit = config.busy_limit,
          .at_loss = config.at_loss,
          .queued_at_most = std::chrono::days(jobs.confirm_days)};
}

}  // namespace

Mill::Mill(const DeviceConfig& device, const MillConfig& config, const JobsConfig& jobs, std::unique_ptr<Line> line,
           LineThread& thread, EventBus& bus, Metrics& metrics, const Executor& readers, LeaseTokens& lease_tokens,
           spool::Spool& spool, std::unique_ptr<JobRecord> record, journal::Journal* journal)
    : Device(device.name,
             beginning_now({.kind = std::string(config.kind->name()), .device = device.name, .baud = device.baud}),
             std::move(line), thread, metrics, readers, lease_tokens, journal),
      config_(config),
      bus_(bus),
      spool_(spool),
      record_(std::move(record)),
      journal_(journal),
      newest_(readers),
      metrics_(*metrics.registry(), device.name),
      controller_(config.model->make_machine(settings_of(config, jobs), runner(), *this, leases())),
      spool_thread_(std::make_unique<boost::asio::thread_pool>(1)) {
  restore_jobs();
  runner().attach(*controller_, [this] { after_call(); });
}

Mill::~Mill() { spool_thread_->join(); }

// Restores jobs that had not ended when the previous run ended. Their confirmations are void.
void Mill::restore_jobs() {
  if (record_ && record_->abort_waited()) controller_->inherit_abort();
  if (record_) controller_->inherit_z0_count(record_->z0_count());
  const auto last = record_ ? record_->before() : std::nullopt;
  if (last) controller_->inherit_left({.number = last->job, .name = last->name, .leaves = last->leaves});
  for (jobs::Job& job : unended_jobs(spool_, name())) {
    plan_again(job);
    if (!last || last->job != job.number) {
      controller_->inherit(std::move(job));
    } else if (jobs::is_end(last->state)) {
      job.state = last->state;
      end_spooled(spool_, name(), job);
    } else {
      job = as_it_was_left(std::move(job), *last);
      note(job, "", "the daemon ended", monotonic_now());
      controller_->inherit(std::move(job));
    }
  }
}

// Plans a job that was kept without its times, or whose settings of sending have changed.
void Mill::plan_again(jobs::Job& job) {
  if (job.planned_for == planned_for(config_)) return;
  if (const auto planned = plan_job(spool_, name(), config_, job, {}); !planned) {
    log::warn("{}: how long {} takes is not known: {}", name(), text_of(job), explain(planned.error()));
  }
}

void Mill::drop_spooled(jobs::JobNumber job) {
  boost::asio::post(*spool_thread_, [this, job] {
    if (const auto removed = spool_.remove(name(), job); !removed) log::warn("{}", explain(removed.error()));
  });
}

// Publishes a fact whose times are shown by the clock of this moment.
void Mill::publish_fact(Fact fact, TimePoint now) {
  bus_.publish(name(), std::move(fact), to_wall(now), moment_of(now));
}

// Reports a job's state to watchers, the log and the journal.
void Mill::note(const jobs::Job& job, std::string_view by, std::string_view why, TimePoint now) {
  log::info("{}: {} is {}{}{}{}{}", name(), text_of(job), jobs::name(job.state), by.empty() ? "" : ", by ", by,
            why.empty() ? "" : ": ", why);
  publish_fact(JobChanged{job, {}, std::string(by), std::string(why)}, now);
  if (journal_ != nullptr) journal_->append({journal::entry_of(job, by, why, name(), now)});
}

void Mill::post(Request request, std::function<void()> too_late) {
  runner().post([this, request = std::move(request)](TimePoint now) { request(*controller_, now); },
                std::move(too_late));
}

void Mill::link_changed(jobs::MachineLink link, std::string_view why, TimePoint now) {
  changed_ = true;
  metrics_.set_link(link);
  const bool open = link == jobs::MachineLink::open;
  const stage::LinkChanged change{open ? stage::LinkState::up : stage::LinkState::down, std::string(why)};
  if (link_ && link_->link == change.link && link_->why == change.why) return;
  link_ = change;
  recorder().on_event(change, now);
  publish_fact(change, now);
  if (open) return log::info("{}: the line is open", name());
  log::warn("{}: the line is closed: {}", name(), why);
}

void Mill::job_changed(const jobs::Job& job, std::string_view by, std::string_view why, TimePoint now) {
  changed_ = true;
  metrics_.count(job, now);
  note(job, by, why, now);
  if (record_ && job.state == jobs::JobState::running) record_->begin(job);
  if (record_) record_->set_state(job);
  if (job.state == jobs::JobState::tool_change) keep(job);
  if (job.state == jobs::JobState::paused) plan_rest(job);
  if (jobs::is_end(job.state)) {
    ended_ = job;
    boost::asio::post(*spool_thread_, [this, job] { end_spooled(spool_, name(), job); });
  }
}

void Mill::keep(const jobs::Job& job) {
  boost::asio::post(*spool_thread_, [this, job] { keep_facts(spool_, name(), job); });
}

// Plans again on the spool's thread, because the strand knows the duration of the rest only roughly. The job is kept
// even if planning fails.
void Mill::plan_rest(const jobs::Job& job) {
  boost::asio::post(*spool_thread_, [this, job] {
    jobs::Job planned = job;
    if (!plan_job(spool_, name(), config_, planned, newest_.get().value->measured_pace)) {
      return keep_facts(spool_, name(), job);
    }
    post([this, planned](jobs::Machine& mill, TimePoint) {
      mill.plan_rest(planned);
      changed_ = true;
    });
  });
}

void Mill::when_kept(std::function<void()> then) { boost::asio::post(*spool_thread_, std::move(then)); }

void Mill::sender_changed(const jobs::RunningJob& running, TimePoint now) {
  changed_ = true;
  const auto job = std::ranges::find(controller_->jobs(), running.number, &jobs::Job::number);
  if (job != controller_->jobs().end() && !is_end(running.sender)) {
    publish_fact(JobChanged{*job, running.sender, "", running.busy ? "the mill takes nothing" : ""}, now);
  }
  if (running.busy) log::warn("{}: the mill takes nothing: look at it", name());
}

void Mill::internal_error(std::string_view what, TimePoint) {
  log::error("{}: {}; the mill is aborted, and its line opened again", name(), what);
}

void Mill::z0_sent(std::uint64_t z0_count) {
  if (record_) record_->set_z0_count(z0_count);
}

void Mill::about_to_write(jobs::JobNumber, const jobs::WrittenRange& sent) {
  if (record_) record_->going_to(sent);
  metrics_.count_written(sent.most);
}

void Mill::written(std::string_view bytes, jobs::JobNumber job) {
  stage::BytesWritten record;
  record.bytes = bytes;
  record.exchange = ++writes_;
  record.lane = Lane::motion;
  record.motion = job;
  recorder().on_event(record, monotonic_now());
}

void Mill::abort_requested(std::string_view by, TimePoint now) {
  metrics_.count_abort();
  const bool runs = controller_->running_job() != 0;
  for (const auto& stop : repeated_stops_.add({.axes = {}, .who = std::string(by), .moved = runs}, now)) {
    log::warn("{}: abort requested by {}{}", name(), stop.who,
              stop.count > 1 ? fmt::format(", {} times while no job ran", stop.count) : "");
    publish_fact(stop, now);
  }
}

void Mill::after_call() {
  const TimePoint now = monotonic_now();
  if (record_) record_->set_abort_waits(controller_->abort_waits());
  if (changed_ || (controller_->running_job() != 0 && now - published_ >= kJobPublishPause)) publish(now);
  look_whether_wound_down(now);
}

void Mill::publish(TimePoint at) {
  changed_ = false;
  published_ = at;
  MillNow state = now(at);
  metrics_.set_state(state.jobs, state.running);
  metrics_.set_pace(state.measured_pace);
  newest_.publish(std::move(state));
}

MillNow Mill::now(TimePoint at) {
  return {controller_->link(),
          link_ ? link_->why : "",
          controller_->jobs(),
          controller_->running(at),
          controller_->measured_pace(),
          moment_of(at),
          ended_,
          controller_->z0_count()};
}

void Mill::wind_down(std::function<void()> done) {
  post([this, done = std::move(done)](jobs::Machine&, TimePoint now) {
    wound_down_ = done;
    abort_at_ = config_.at_exit == MillConfig::AtExit::finish ? now + kJobFinishLimit : now;
  });
}

// Also works while a job continues: its controller is called at least every kLook.
void Mill::look_whether_wound_down(TimePoint now) {
  if (!wound_down_) return;
  if (controller_->is_idle()) {
    const auto done = std::exchange(wound_down_, {});
    shutdown();
    log::info("{}: the line is closed", name());
    return done();
  }
  const auto running = controller_->running(now);
  const bool waits = running && running->sender == jobs::SenderState::paused;
  if (!running || abort_at_ == TimePoint::max() || (now < abort_at_ && !waits)) return;
  abort_at_ = TimePoint::max();
  post([](jobs::Machine& mill, TimePoint at) { mill.abort("the daemon, which ends", at); });
}

Duration Mill::wind_down_limit() const {
  return kAbortLimit + (config_.at_exit == MillConfig::AtExit::finish ? kJobFinishLimit : Duration::zero());
}

}  // namespace axisgate::server
