#include "tests/echo/machine.h"

#include <algorithm>

namespace axisgate::echo {

EchoMachine::EchoMachine(const jobs::MachineSettings& settings, FlowLink& line, jobs::MachineEvents& events,
                         use::Permission& permission)
    : line_(line),
      events_(events),
      rights_(permission),
      queue_(left_, settings.queued_at_most, events, *this),
      confirmations_(queue_, left_, settings.confirmation_lasts) {}

Result<void> EchoMachine::check_open() const {
  if (link_ == jobs::MachineLink::open) return {};
  return fail(Reason::link_down, "the line to the echo machine is closed", "ask again when it is open");
}

Result<void> EchoMachine::confirm(jobs::JobNumber job, const jobs::JobSetup& seen, std::string by, TimePoint now) {
  return confirmations_.check_next(job).and_then([&] { return check_open(); }).and_then([&] {
    return confirmations_.confirm(job, seen, std::move(by), now);
  });
}

Result<void> EchoMachine::check_startable(jobs::JobNumber number, TimePoint now) {
  if (run_) return fail(Reason::wrong_job_state, "another job runs", "wait until it has ended");
  return queue_.find(number).and_then(
      [&](const jobs::Job* job) { return check_open().and_then([&] { return confirmations_.check(*job, now); }); });
}

Result<void> EchoMachine::start(jobs::JobNumber number, std::shared_ptr<const jobs::PreparedJob> prepared,
                                const use::RequestContext& by, TimePoint now) {
  const Result<void> can = check_startable(number, now).and_then([&] { return rights_.authorize(by, number, now); });
  if (!can) return can;
  jobs::Job& job = queue_.at(number);
  left_.job_begins(job);
  run_ = Run{number, std::static_pointer_cast<const PreparedText>(std::move(prepared)), 0, 0, next_byte(job), now};
  queue_.change(job, jobs::JobEvent::start, by.who, "", now);
  rights_.job_begins(job, by, now);
  send_next(now);
  return {};
}

Result<void> EchoMachine::pause(bool raise, TimePoint now) {
  if (!run_ || raise)
    return fail(Reason::wrong_job_state, "no job is being sent, or there is no tool to raise", "wait");
  run_->paused = true;
  events_.sender_changed(view(), now);
  return {};
}

Result<void> EchoMachine::resume(const use::RequestContext& by, TimePoint now) {
  if (!run_ || !run_->paused) return fail(Reason::wrong_job_state, "no job is paused", "start one");
  if (const Result<void> can = rights_.authorize(by, run_->number, now); !can) return can;
  run_->paused = false;
  events_.sender_changed(view(), now);
  send_next(now);
  return {};
}

Result<void> EchoMachine::choose_rest(jobs::JobNumber number, const jobs::JobRest& rest, std::string_view by,
                                      TimePoint now) {
  const Result<jobs::Job*> job = queue_.find(number);
  if (!job) return tl::unexpected(job.error());
  if (!jobs::next((*job)->state, jobs::JobEvent::choose_rest)) {
    return fail(Reason::wrong_job_state, "the job is not paused", "start it");
  }
  (*job)->setup.from = rest.from;
  queue_.change(**job, jobs::JobEvent::choose_rest, by, "it continues at a line", now);
  return {};
}

bool EchoMachine::abort(const use::RequestContext& by, TimePoint now) {
  rights_.stop_asked(by, now);
  return abort(by.who, now);
}

bool EchoMachine::abort(std::string_view by, TimePoint now) {
  events_.abort_requested(by, now);
  confirmations_.make_void("an abort", now);
  if (link_ != jobs::MachineLink::open) {
    abort_waits_ = true;
    return false;
  }
  write(kAbort);
  if (run_) end(jobs::JobEvent::aborted, by, "", now);
  return true;
}

Result<void> EchoMachine::cancel(jobs::JobNumber job, std::string_view by, TimePoint now) {
  return queue_.request(job, jobs::JobEvent::cancel, by, now);
}

Result<void> EchoMachine::done(jobs::JobNumber job, std::string_view by, TimePoint now) {
  return queue_.request(job, jobs::JobEvent::done, by, now);
}

Result<Duration> EchoMachine::operate(const jobs::HandAct&, const use::RequestContext&, TimePoint) {
  return fail(Reason::invalid_request, "an echo machine does nothing by hand", "send it a job");
}

std::optional<jobs::RunningJob> EchoMachine::running(TimePoint) { return run_ ? std::optional(view()) : std::nullopt; }

std::uint64_t EchoMachine::byte_after(std::size_t lines) const {
  return lines == 0 ? run_->from : run_->text->lines[lines - 1].end;
}

jobs::RunningJob EchoMachine::view() const {
  jobs::RunningJob view;
  view.number = run_->number;
  view.sender = run_->paused ? jobs::SenderState::paused : jobs::SenderState::sending;
  const std::uint64_t answered = byte_after(run_->answered);
  view.progress = {byte_after(run_->sent), 0, answered, answered, byte_after(run_->sent)};
  view.run_on = run_->text->run_on();
  view.started = run_->started;
  return view;
}

void EchoMachine::write(std::string_view bytes) {
  line_.write(bytes);
  events_.written(bytes, running_job());
}

void EchoMachine::send_next(TimePoint now) {
  if (run_->paused || run_->sent > run_->answered) return;
  if (run_->answered == run_->text->lines.size()) return end(jobs::JobEvent::fed, "", "", now);
  events_.about_to_write(run_->number, {byte_after(run_->answered), byte_after(run_->sent + 1)});
  write(run_->text->lines[run_->sent++].text);
}

void EchoMachine::end(jobs::JobEvent event, std::string_view by, std::string_view why, TimePoint now) {
  jobs::Job& job = queue_.at(run_->number);
  if (event == jobs::JobEvent::lost)
    job.written = jobs::WrittenRange{byte_after(run_->answered), byte_after(run_->sent)};
  rights_.job_ends(run_->number, now);
  run_.reset();
  queue_.change(job, event, by, why, now);
}

void EchoMachine::link_up(TimePoint now) {
  link_ = jobs::MachineLink::open;
  events_.link_changed(link_, "", now);
  if (std::exchange(abort_waits_, false)) write(kAbort);
}

void EchoMachine::link_down(TimePoint now, std::string_view why) {
  link_ = jobs::MachineLink::closed;
  events_.link_changed(link_, why, now);
  confirmations_.make_void("the line was lost", now);
  if (run_) end(jobs::JobEvent::lost, "", why, now);
  received_.clear();
  line_.reopen(std::chrono::milliseconds(250));
}

void EchoMachine::receive(std::string_view bytes, TimePoint now) {
  received_ += bytes;
  for (std::size_t end = received_.find('\n'); end != std::string::npos; end = received_.find('\n')) {
    const std::string line = received_.substr(0, end + 1);
    received_.erase(0, end + 1);
    if (!run_ || run_->sent == run_->answered || line != run_->text->lines[run_->answered].text) continue;
    ++run_->answered;
    send_next(now);
  }
}

void EchoMachine::advance(TimePoint now) {
  rights_.advance(
      [&](std::string_view who) {
        if (run_) abort(who, now);
      },
      now);
  confirmations_.advance(now);
  queue_.expire(now);
}

std::optional<TimePoint> EchoMachine::next_deadline() const {
  std::optional<TimePoint> next = rights_.next_deadline();
  for (const auto& other : {confirmations_.until(), queue_.next_expiry()}) {
    if (other) next = std::min(next.value_or(*other), *other);
  }
  return next;
}

void EchoMachine::illegal(std::string_view machine, std::string_view state, std::string_view event) {
  events_.internal_error(std::string(machine) + " in " + std::string(state) + ": " + std::string(event), TimePoint{});
}

}  // namespace axisgate::echo
