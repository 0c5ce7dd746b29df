#include "device/rml1/mill/mill_controller.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "device/jobs/guard.h"

namespace axisgate::rml1 {
namespace {

Result<void> check_same_bytes(const jobs::Job& confirmed, const PreparedJob& prepared) {
  if (prepared.digest() == confirmed.setup.digest && prepared.begin() == part_begin(confirmed) &&
      prepared.from() == confirmed.setup.from) {
    return {};
  }
  return fail(Reason::internal, fmt::format("the bytes of {} are not those that were confirmed", text_of(confirmed)),
              "send the job again");
}

// Returns the earliest of the times; nullopt if all of them are nullopt.
std::optional<TimePoint> earliest(std::initializer_list<std::optional<TimePoint>> times) {
  std::optional<TimePoint> found;
  for (const auto& time : times) {
    if (time) found = std::min(found.value_or(*time), *time);
  }
  return found;
}

}  // namespace

void MillController::NotedLine::write(std::string_view bytes) {
  mill_.run_.about_to_write(bytes.size(), line_.unsent());
  line_.write(bytes);
  mill_.events_.written(bytes, mill_.run_.number());
}

MillController::MillController(const Profile& profile, const jobs::MachineSettings& settings, FlowLink& line,
                               jobs::MachineEvents& events, use::Permission& permission)
    : settings_(settings),
      line_(*this, line),
      events_(events),
      rights_(permission),
      queue_(left_, settings.queued_at_most, events, *this),
      confirmations_(queue_, left_, settings.confirmation_lasts),
      abort_(profile, settings_.sending, line_, *this),
      hand_(profile, settings.sending.slack, line_, abort_),
      run_(profile, {settings.sending.converter, settings.busy_limit}, {line_, abort_, *this}, queue_, rights_,
           events) {}

void MillController::inherit(jobs::Job job) {
  if (job.state == jobs::JobState::paused_unknown && settings_.at_loss == jobs::AtLoss::abort) abort_.postpone();
  queue_.inherit(std::move(job));
}

void MillController::inherit_left(const jobs::Job& last) {
  left_.inherit(last);
  queue_.show_left();
}

Result<void> MillController::check_open() const {
  if (link_ == jobs::MachineLink::open) return {};
  return fail(Reason::link_down, "the line to the mill is closed", "ask again when it is open");
}

Result<void> MillController::check_no_job_runs(std::string_view hint) const {
  if (run_.number() == 0) return {};
  return fail(Reason::wrong_job_state, fmt::format("job {} runs", run_.number()), std::string(hint));
}

Result<void> MillController::confirm(jobs::JobNumber number, const jobs::JobSetup& seen, std::string by,
                                     TimePoint now) {
  return check_no_job_runs("confirm the next one when it has ended")
      .and_then([&] { return confirmations_.check_next(number); })
      .and_then([&] { return check_open(); })
      .and_then([&] { return confirmations_.confirm(number, seen, std::move(by), now); });
}

Result<void> MillController::check_startable(const jobs::Job& job, TimePoint now) const {
  return check_no_job_runs("wait until it has ended")
      .and_then([&] { return check_open(); })
      .and_then([&] { return confirmations_.check(job, now); })
      .and_then([&] { return hand_.check_idle(now); });
}

Result<void> MillController::check_startable(jobs::JobNumber number, TimePoint now) {
  return queue_.find(number).and_then([&](const jobs::Job* job) { return check_startable(*job, now); });
}

Result<void> MillController::start(jobs::JobNumber number, std::shared_ptr<const jobs::PreparedJob> part,
                                   const use::RequestContext& by, TimePoint now) {
  const Result<jobs::Job*> found = queue_.find(number);
  if (!found) return tl::unexpected(found.error());
  jobs::Job& job = **found;
  auto prepared = std::static_pointer_cast<const PreparedJob>(std::move(part));
  const Result<void> can =
      check_startable(job, now).and_then([&] { return check_same_bytes(job, *prepared); }).and_then([&] {
        return rights_.authorize(by, number, now);
      });
  if (!can) return can;
  if (waits_to_begin(job)) left_.job_begins(job);
  if (job.leaves.surface) count_surface();
  job.z0_count = left_.z0_count();
  run_.start(job, std::move(prepared), by, now);
  return {};
}

Result<void> MillController::resume(const use::RequestContext& by, TimePoint now) {
  const Result<void> can = run_.check_resumable().and_then([&] { return rights_.authorize(by, 0, now); });
  if (can) run_.resume(now);
  return can;
}

Result<void> MillController::choose_rest(jobs::JobNumber number, const jobs::JobRest& rest, std::string_view by,
                                         TimePoint now) {
  const Result<jobs::Job*> found = queue_.find(number);
  if (!found) return tl::unexpected(found.error());
  jobs::Job& job = **found;
  if (!next(job.state, jobs::JobEvent::choose_rest)) {
    return fail(Reason::wrong_job_state, fmt::format("{} is {}", text_of(job), name(job.state)),
                "only a job that is PAUSED_UNKNOWN or PAUSED is continued from a line");
  }
  job.setup.from = rest.from;
  set_plan(job, rest.takes, rest.run_on);
  queue_.change(job, jobs::JobEvent::choose_rest, by,
                fmt::format("it continues at line {}, column {}", rest.from.line, rest.from.column), now);
  return {};
}

void MillController::plan_rest(const jobs::Job& planned) {
  const Result<jobs::Job*> job = queue_.find(planned.number);
  const bool same = job && (*job)->state == jobs::JobState::paused && (*job)->setup.from == planned.setup.from &&
                    (*job)->part == planned.part && planned.part < planned.parts.size() &&
                    planned.parts.size() == (*job)->parts.size();
  if (same) (*job)->parts[planned.part] = planned.parts[planned.part];
}

bool MillController::abort(const use::RequestContext& by, TimePoint now) {
  rights_.stop_asked(by, now);
  return abort(by.who, now);
}

bool MillController::abort(std::string_view by, TimePoint now) {
  events_.abort_requested(by, now);
  if (guarded(jobs::MillGuard::void_after_abort)) setup_changed("an abort", now);
  if (run_.number() == 0) return send_abort(now);
  run_.abort(by, now);
  return true;
}

// The abort is written although no job runs, because the mill may still execute a job that has ended in the queue.
bool MillController::send_abort(TimePoint now) {
  if (link_ != jobs::MachineLink::open) {
    abort_.postpone();
    return false;
  }
  abort_.write(true, now);
  return true;
}

Result<void> MillController::cancel(jobs::JobNumber job, std::string_view by, TimePoint now) {
  return queue_.request(job, jobs::JobEvent::cancel, by, now);
}

Result<void> MillController::done(jobs::JobNumber job, std::string_view by, TimePoint now) {
  return queue_.request(job, jobs::JobEvent::done, by, now);
}

void MillController::count_surface() { events_.z0_sent(left_.count_surface()); }

Result<Duration> MillController::operate(const jobs::HandAct& act, const use::RequestContext& by, TimePoint now) {
  const Result<HandCommands> words = hand_.words(act);
  if (!words) return tl::unexpected(words.error());
  const Result<void> can = check_no_job_runs("wait until it has ended")
                               .and_then([&] { return check_open(); })
                               .and_then([&] { return hand_.check(act, now); })
                               .and_then([&] { return rights_.authorize(by, 0, now); });
  if (!can) return tl::unexpected(can.error());
  setup_changed(fmt::format("{} had the mill {}", by.who, text_of(act)), now);
  const Duration done_in = hand_.write(*words, now);
  if (std::holds_alternative<jobs::SetZ0>(act)) {
    count_surface();
    left_.surface_set_by_hand();
    queue_.show_left();
  }
  return done_in;
}

void MillController::link_up(TimePoint now) {
  now_ = now;
  link_ = jobs::MachineLink::open;
  reopen_ = kReopenFirst;
  events_.link_changed(link_, "", now);
  if (abort_.phase() == AbortPhase::waits && guarded(jobs::MillGuard::abort_after_loss)) abort_.write(true, now);
}

void MillController::link_down(TimePoint now, std::string_view why) {
  now_ = now;
  link_ = jobs::MachineLink::closed;
  events_.link_changed(link_, why, now);
  if (guarded(jobs::MillGuard::void_after_loss)) setup_changed("the line was lost", now);
  abort_.line_lost(now);
  if (run_.number() != 0 && settings_.at_loss == jobs::AtLoss::abort) abort_.postpone();
  run_.line_lost(why, now);
  line_.reopen(reopen_);
  reopen_ = std::min(2 * reopen_, kReopenLast);
}

void MillController::illegal(std::string_view machine, std::string_view state, std::string_view event) {
  if (!internal_error_.empty()) return;
  internal_error_ = fmt::format("an internal error: {} in state {} cannot have the event {}", machine, state, event);
}

// Aborts the mill, because its state is unknown; a person must look at the workpiece. Closing the line discards the
// bytes that wait in the host, so the abort is the first thing sent after the line is open again.
void MillController::recover(TimePoint now) {
  events_.internal_error(internal_error_, now);
  run_.abandon(internal_error_, now);
  if (link_ == jobs::MachineLink::open) link_down(now, internal_error_);
  abort_.postpone();
  internal_error_.clear();
}

void MillController::advance(TimePoint now) {
  now_ = now;
  if (!internal_error_.empty()) recover(now);
  rights_.advance(
      [&](std::string_view who) {
        if (run_.number() != 0) abort(who, now);
      },
      now);
  confirmations_.advance(now);
  queue_.expire(now);
  abort_.advance(now);
  run_.advance(now);
}

std::optional<TimePoint> MillController::next_deadline() const {
  if (!internal_error_.empty()) return now_;
  if (abort_.phase() == AbortPhase::leaves) return now_ + Abort::kLook;
  const auto lease = rights_.next_deadline();
  if (run_.number() != 0) return earliest({run_.next_deadline(now_), lease});
  return earliest({confirmations_.until(), queue_.next_expiry(), lease});
}

std::string MillController::broken_invariant() const {
  if (std::string broken = queue_.broken_invariant(); !broken.empty()) return broken;
  if (std::string broken = run_.broken_invariant(); !broken.empty()) return broken;
  const bool open = link_ == jobs::MachineLink::open;
  if (!open && run_.number() != 0) return "a job runs, and the line is closed";
  const AbortPhase phase = abort_.phase();
  const bool on_its_way = phase == AbortPhase::leaves || phase == AbortPhase::travels;
  if (!open && on_its_way) return "an abort is on its way, and the line is closed";
  return "";
}

}  // namespace axisgate::rml1
