#include "device/rml1/mill/mill_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "device/rml1/guard.h"
#include "device/rml1/sending/words.h"

namespace axisgate::rml1 {
namespace {

constexpr std::string_view kExpired = "the confirmation has expired";

bool waits(const Job& job) {
  return job.state == JobState::queued || job.state == JobState::confirmed || job.state == JobState::tool_change ||
         job.state == JobState::paused;
}

// A mill is used as a whole.
stage::Use use_of(const stage::RequestContext& by, JobNumber job) {
  return {by.who, by.lease, stage::AxisSet::all(), job, by.session};
}

stage::Occupation occupation_by(const Job& job, const std::string& who, TimePoint now) {
  return {fmt::format("{}, started by {}", job.name, who), fmt::format("job {} runs", job.number), "",
          now + takes(job).most};
}

Result<void> check_same(const Job& confirmed, const PreparedJob& prepared) {
  if (prepared.digest() == confirmed.setup.digest && prepared.begin() == part_begin(confirmed) &&
      prepared.from() == confirmed.setup.from) {
    return {};
  }
  return fail(Reason::internal, fmt::format("the bytes of {} are not those that were confirmed", text_of(confirmed)),
              "send the job again");
}

std::optional<TimePoint> sooner(std::optional<TimePoint> one, std::optional<TimePoint> other) {
  if (!one || !other) return one ? one : other;
  return std::min(*one, *other);
}

}  // namespace

void MillController::NotedLine::write(std::string_view bytes) {
  Running* const running = mill_.running_.get();
  if (running != nullptr && running->sender.state() == SenderState::sending) {
    const std::uint64_t least = mill_.in_mill(running->noted - std::min<std::uint64_t>(line_.unsent(), running->noted));
    running->noted += bytes.size();
    const PreparedJob& job = *running->prepared;
    mill_.events_.about_to_write(running->number, {job.of_body(least), job.of_body(running->noted)});
  }
  line_.write(bytes);
  mill_.events_.written(bytes, running == nullptr ? 0 : running->number);
}

MillController::MillController(const Profile& profile, const MillSettings& settings, FlowLink& line, MillEvents& events,
                               stage::Permission& permission)
    : profile_(profile),
      settings_(settings),
      line_(line),
      noted_line_(*this, line),
      events_(events),
      permission_(permission),
      abort_(profile, settings_.sending, noted_line_, *this) {}

void MillController::add(Job job, TimePoint now) {
  job.state = JobState::queued;
  job.queued_since = now;
  jobs_.push_back(std::move(job));
  show_left();
  events_.job_changed(jobs_.back(), jobs_.back().owner, "", now);
}

Result<Job*> MillController::find(JobNumber number) {
  const auto found = std::ranges::find(jobs_, number, &Job::number);
  if (found != jobs_.end()) return &*found;
  return fail(Reason::not_found, fmt::format("there is no job {} in the queue", number),
              "`axisctl mill queue` lists them");
}

void MillController::change(Job& job, JobEvent event, std::string_view by, std::string_view why, TimePoint now) {
  const auto to = next(job.state, event);
  if (!to) return illegal("job", name(job.state), name(event));
  job.state = *to;
  if (job.state != JobState::confirmed) job.confirmation.reset();
  if (job.state == JobState::queued) job.queued_since = now;
  show_left();
  events_.job_changed(job, by, why, now);
}

Result<void> MillController::change(JobNumber number, JobEvent event, std::string_view by, TimePoint now) {
  const Result<Job*> job = find(number);
  if (!job) return tl::unexpected(job.error());
  if (!next((*job)->state, event)) {
    return fail(Reason::wrong_mode, fmt::format("{} is {}", text_of(**job), name((*job)->state)),
                "`axisctl mill queue` shows what can be done with it");
  }
  change(**job, event, by, "", now);
  leave_queue_if_ended(number);
  return {};
}

void MillController::leave_queue_if_ended(JobNumber number) {
  std::erase_if(jobs_, [number](const Job& job) { return job.number == number && is_end(job.state); });
}

// A person confirms the next job with what the one before has left. In the middle of a job they confirm the tool and Z0
// in any case.
void MillController::show_left() {
  const auto first = std::ranges::find_if(jobs_, waits);
  for (Job& job : jobs_) job.setup.left.clear();
  if (first != jobs_.end() && waits_to_begin(*first)) first->setup.left = left_by(last_);
}

// The workpiece of a job that ran may still be in the mill.
Result<void> MillController::check_settled() const {
  if (!guarded(MillGuard::settled_before_next)) return {};
  const auto open = std::ranges::find_if(
      jobs_, [](const Job& job) { return job.state == JobState::fed || job.state == JobState::paused_unknown; });
  if (open == jobs_.end()) return {};
  const bool fed = open->state == JobState::fed;
  return fail(Reason::wrong_mode, fmt::format("{} is {}", text_of(*open), name(open->state)),
              fed ? "look at its workpiece, then say that it is done: `axisctl mill done`"
                  : "look at the mill, then take the job out of the queue: `axisctl mill cancel`");
}

Result<void> MillController::check_next(const Job& job) const {
  if (running_) {
    return fail(Reason::wrong_mode, fmt::format("job {} runs", running_->number),
                "confirm the next one when it has ended");
  }
  if (const Result<void> settled = check_settled(); !settled) return settled;
  const auto first = std::ranges::find_if(jobs_, waits);
  if (first != jobs_.end() && first->number == job.number) return {};
  if (first == jobs_.end() || !waits(job)) {
    return fail(Reason::wrong_mode, fmt::format("{} is {}", text_of(job), name(job.state)),
                "only a job that waits can be confirmed");
  }
  if (first->setup.from && !waits_to_begin(*first)) {
    return fail(Reason::wrong_mode,
                fmt::format("{} is not finished: it continues at line {}", text_of(*first), first->setup.from->line),
                "confirm that one, or have it cancelled");
  }
  if (first->part > 0 && !waits_to_begin(*first)) {
    return fail(Reason::wrong_mode,
                fmt::format("{} is not finished: its next tool is {}", text_of(*first), first->setup.tool),
                "confirm that one, or have it cancelled");
  }
  return fail(Reason::wrong_mode, fmt::format("{} is before {}", text_of(*first), text_of(job)),
              "confirm that one, or have it cancelled; `axisctl mill first` moves a job forward");
}

Result<void> MillController::confirm(JobNumber number, const JobSetup& seen, std::string by, TimePoint now) {
  const Result<Job*> job = find(number);
  if (!job) return tl::unexpected(job.error());
  if (const Result<void> is_next = check_next(**job); !is_next) return is_next;
  if (link_ != MillLink::open)
    return fail(Reason::link_down, "the line to the mill is closed", "confirm when it is open");
  if (const Result<void> same = check_surface(**job); !same) return same;
  if (seen.left != (*job)->setup.left) {
    return fail(Reason::stale_setpoint,
                fmt::format("before {}: {}; that is not what was seen", text_of(**job),
                            (*job)->setup.left.empty() ? "nothing is left"
                                                       : fmt::format("{}", fmt::join((*job)->setup.left, ", "))),
                "look at the job again, then confirm it");
  }
  if (seen != (*job)->setup) {
    return fail(
        Reason::stale_setpoint,
        fmt::format("{} needs the tool {}, the origin {} and the profile {}, or its bytes are others than those seen",
                    text_of(**job), (*job)->setup.tool, (*job)->setup.origin, (*job)->setup.profile),
        "look at the job again, then confirm what it needs");
  }
  (*job)->confirmation = Confirmation{by, now + settings_.confirmation_lasts};
  (*job)->void_because.clear();
  change(**job, JobEvent::confirm, by, "", now);
  return {};
}

Result<void> MillController::check_free() const {
  if (running_)
    return fail(Reason::wrong_mode, fmt::format("job {} runs", running_->number), "wait until it has ended");
  if (link_ != MillLink::open)
    return fail(Reason::link_down, "the line to the mill is closed", "ask again when it is open");
  return {};
}

Result<void> MillController::check_startable(const Job& job, TimePoint now) const {
  if (const Result<void> free = check_free(); !free) return free;
  if (job.state != JobState::confirmed || job.confirmation->until <= now) {
    return fail(Reason::not_allowed,
                job.void_because.empty()
                    ? fmt::format("{} is not confirmed at the mill", text_of(job))
                    : fmt::format("{} is no longer confirmed at the mill, since {}", text_of(job), job.void_because),
                "somebody at the mill confirms it: `axisctl mill confirm`");
  }
  const Result<void> taken = check_taken();
  return taken ? check_still(now) : taken;
}

Result<void> MillController::check_startable(JobNumber number, TimePoint now) {
  return find(number).and_then([&](const Job* job) { return check_startable(*job, now); });
}

Result<void> MillController::start(JobNumber number, std::shared_ptr<const PreparedJob> prepared,
                                   const stage::RequestContext& by, TimePoint now) {
  const Result<Job*> job = find(number);
  if (!job) return tl::unexpected(job.error());
  if (const Result<void> startable = check_startable(**job, now); !startable) return startable;
  if (const Result<void> same = check_same(**job, *prepared); !same) return same;
  if (const Result<void> may = authorize(by, number, now); !may) return may;
  if (waits_to_begin(**job)) last_ = {.number = number, .name = (*job)->name, .leaves = (*job)->leaves};
  if ((*job)->leaves.surface) set_surfaces(surfaces_ + 1);
  (*job)->surfaces = surfaces_;
  (*job)->written.reset();
  (*job)->executed.reset();
  set_plan(**job, prepared->times().whole(), prepared->plan().run_on);
  change(**job, JobEvent::start, by.who, "", now);
  permission_.begin(use_of(by, number), occupation_by(**job, by.who, now), now);
  const PreparedJob& it = *prepared;
  running_.reset(
      new Running{number, std::move(prepared), now,
                  Sender(it.text(), it.timeline(), profile_, it.settings(), it.plan(), {noted_line_, abort_, *this}),
                  SenderState::ready, 0, 0, now, false, ""});
  running_->sender.start(now);
  look_at_sender(now);
  return {};
}

Result<void> MillController::authorize(const stage::RequestContext& by, JobNumber job, TimePoint now) {
  return permission_.authorize(use_of(by, job), now);
}

// Those who may not use the mill any longer have their job aborted.
void MillController::follow_leases(TimePoint now) {
  const stage::Orders orders = permission_.advance(now);
  for (const stage::StopOrder& order : orders.stops) {
    if (running_) abort(order.who, now);
    permission_.stopped(order.id, now);
  }
  for (const stage::EndedLease& lease : orders.restoring) permission_.settings_restored(lease.token, now);
}

bool MillController::abort(const stage::RequestContext& by, TimePoint now) {
  permission_.stop_asked(use_of(by, 0), {}, now);
  return abort(by.who, now);
}

Result<void> MillController::cancel(JobNumber job, std::string_view by, TimePoint now) {
  return change(job, JobEvent::cancel, by, now);
}

Result<void> MillController::done(JobNumber job, std::string_view by, TimePoint now) {
  return change(job, JobEvent::done, by, now);
}

void MillController::setup_changed(std::string_view why, TimePoint now) {
  for (Job& job : jobs_) {
    if (job.state != JobState::confirmed) continue;
    job.void_because = why;
    change(job, void_event(job), "", why, now);
  }
}

std::optional<RunningJob> MillController::running(TimePoint now) {
  if (!running_) return std::nullopt;
  return view(now);
}

RunningJob MillController::view(TimePoint now) {
  SendProgress progress = running_->sender.progress(now);
  const PreparedJob& job = *running_->prepared;
  TimeRange left = left_of(job, progress, running_->sender.measured_pace());
  left += takes_later(**find(running_->number));
  progress = {job.of_body(progress.written), progress.unsent, job.of_body(progress.taken),
              job.of_body(progress.executed_least), job.of_body(progress.executed_most)};
  return {.number = running_->number,
          .sender = running_->sender.state(),
          .progress = progress,
          .run_on = running_->sender.run_on(),
          .left = left,
          .started = running_->started,
          .busy = running_->busy};
}

void MillController::look_at_sender(TimePoint now) {
  if (!running_) return;
  look_whether_busy(now);
  const SenderState state = running_->sender.state();
  if (std::exchange(running_->seen, state) != state) events_.sender_changed(view(now), now);
  if (state == SenderState::fed) end_fed_part(now);
  if (state == SenderState::raised) end_raised(now);
  if (state == SenderState::aborted) end_aborted(now);
}

// A mill that is held by its panel, off, or behind a full buffer takes nothing; which of these, the line does not say.
void MillController::look_whether_busy(TimePoint now) {
  const SendProgress progress = running_->sender.progress(now);
  const std::uint64_t left = progress.written - progress.unsent;
  const SenderState state = running_->sender.state();
  const bool has_sent =
      state == SenderState::sending || state == SenderState::finishing || state == SenderState::raising;
  const bool has_more = progress.unsent > 0 || (has_sent && line_.held());
  if (left != running_->left || !has_more) {
    running_->left = left;
    running_->left_at = now;
  }
  const bool busy = now - running_->left_at >= settings_.busy_limit;
  if (std::exchange(running_->busy, busy) != busy) events_.sender_changed(view(now), now);
}

void MillController::end_fed_part(TimePoint now) {
  if (const auto measured = running_->sender.measured_pace()) measured_pace_ = measured;
  const Job& job = **find(running_->number);
  if (is_last_part(job)) return end_run(JobEvent::fed, "", "", now);
  end_run(JobEvent::part_fed, "", fmt::format("the next tool is {}", job.parts[job.part + 1].tool), now);
}

void MillController::end_run(JobEvent event, std::string_view by, std::string_view why, TimePoint now) {
  const std::string requested_by(by);  // it may be of what runs
  const JobNumber number = running_->number;
  Job& job = **find(number);
  if (event == JobEvent::lost || event == JobEvent::abort_unsure) job.written = written_at_loss();
  running_.reset();
  permission_.end(number, now);
  if (event == JobEvent::part_fed) go_to_part(job, job.part + 1);
  change(job, event, requested_by, why, now);
  leave_queue_if_ended(number);
}

// Bytes that have left the host may still be in a converter, which is gone with the line.
std::uint64_t MillController::in_mill(std::uint64_t left) const {
  const std::uint64_t converter = guarded(MillGuard::converter_in_range) ? settings_.sending.converter : 0;
  return left - std::min(converter, left);
}

WrittenRange MillController::written_at_loss() {
  return {running_->prepared->of_body(in_mill(running_->left)), running_->prepared->of_body(running_->noted)};
}

void MillController::link_up(TimePoint now) {
  now_ = now;
  link_ = MillLink::open;
  reopen_ = kReopenFirst;
  events_.link_changed(link_, "", now);
  if (abort_.phase() == AbortPhase::waits && guarded(MillGuard::abort_after_loss)) send_abort(now);
}

void MillController::link_down(TimePoint now, std::string_view why) {
  now_ = now;
  link_ = MillLink::closed;
  events_.link_changed(link_, why, now);
  if (guarded(MillGuard::void_after_loss)) setup_changed("the line was lost", now);
  abort_.line_lost(now);
  if (running_ && settings_.at_loss == AtLoss::abort) abort_.postpone();
  if (running_) {
    running_->sender.line_lost(now);
    end_run(JobEvent::lost, "", why, now);
  }
  line_.reopen(reopen_);
  reopen_ = std::min(2 * reopen_, kReopenLast);
}

void MillController::advance(TimePoint now) {
  now_ = now;
  if (!internal_error_.empty()) recover(now);
  follow_leases(now);
  if (const auto until = confirmed_until(); until && *until <= now) setup_changed(kExpired, now);
  expire_jobs(now);
  abort_.advance(now);
  if (!running_) return;
  running_->sender.advance(now);
  look_at_sender(now);
}

std::optional<TimePoint> MillController::confirmed_until() const {
  const auto found = std::ranges::find(jobs_, JobState::confirmed, &Job::state);
  return found == jobs_.end() ? std::nullopt : std::optional(found->confirmation->until);
}

std::optional<TimePoint> MillController::next_deadline() const {
  if (!internal_error_.empty()) return now_;
  if (abort_.phase() == AbortPhase::leaves) return now_ + Abort::kLook;
  const auto lease = permission_.next_deadline();
  if (!running_) return sooner(sooner(confirmed_until(), next_expiry()), lease);
  const TimePoint look = now_ + kLook;
  return std::min({running_->sender.next_deadline(now_).value_or(look), look, lease.value_or(look)});
}

}  // namespace axisgate::rml1
