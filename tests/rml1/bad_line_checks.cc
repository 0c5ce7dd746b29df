// Requirements at the end of a run, and requests that must be refused.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string_view>

#include "tests/rml1/bad_line.h"

namespace axisgate::rml1 {

void BadLine::expect_not_startable(std::string_view why) {
  const std::uint64_t before = job_written_;
  expect_refused(mill_.start(kFirst, prepared_, kOwner, bench_.now), Reason::not_confirmed, why);
  if (job_written_ > before) violate(fmt::format("written of the job, although {}", why));
}

void BadLine::expect_refused(const Result<void>& result, Reason reason, std::string_view what) {
  if (result) return violate(fmt::format("not refused, although {}", what));
  if (result.error().reason != reason) violate(fmt::format("{}: refused for {}", what, result.error().message));
}

void BadLine::expect_end() {
  if (result_.violation) return;
  if (runs() && result_.byte_changed) {
    abort();  // a changed speed or dwell may take hours
  } else if (runs() && (plan_.sticks_forever || line_.has_lost_xon())) {
    expect_busy_and_abort();
  }
  run_for(std::chrono::seconds(1));
  if (runs()) return violate("the job does not end");
  const jobs::JobState outcome = state();
  const bool fed = outcome == jobs::JobState::fed;
  if (fed && plan_.sticks_forever && result_.stuck) violate("CTS is stuck for ever, and the job is FED");
  run_for(std::chrono::minutes(30));  // enough for anything in the mill
  if (outcome == jobs::JobState::aborted) expect_little_ran_on();
  if (outcome == jobs::JobState::paused_unknown) expect_range_holds();
}

void BadLine::expect_busy_and_abort() {
  result_.was_busy = mill_.running(bench_.now)->busy;
  if (!result_.was_busy) violate("the mill has taken nothing for longer than busy_limit, and is not said to be busy");
  note("abort");
  abort();
  run_for(std::chrono::seconds(1));
  if (state() != jobs::JobState::aborted || line_.unsent() > 0) violate("an abort has not left the host after 1 s");
}

// FED applies to the slowest mill, with a tolerance of a thousandth of the job's time.
void BadLine::expect_fed_is_true() {
  const std::chrono::duration<double> thousandth(prepared_->timeline().slowest_s() / 1000);
  run_for(std::chrono::duration_cast<Duration>(thousandth) + std::chrono::milliseconds(1));
  if (!is_hidden() && !executed_.whole()) violate("the job is FED, and the mill has not executed all of it");
}

// Expects that bytes which have not reached the mill are reported neither as taken nor as executed.
void BadLine::expect_progress_is_true() {
  if (!runs() || is_hidden()) return;
  const jobs::SendProgress progress = mill_.running(bench_.now)->progress;
  const std::uint64_t arrived = prepared_->of_body(job_arrived_);
  if (progress.executed_least > progress.taken) violate("more is said to be executed than is taken");
  if (progress.taken > arrived)
    violate(fmt::format("{} bytes are said to be taken, {} have arrived", progress.taken, arrived));
  if (progress.taken < taken_) violate(fmt::format("{} bytes were said to be taken, now {}", taken_, progress.taken));
  taken_ = progress.taken;
}

// Expects few bytes to run on. After a lost XON the bytes in a converter are unknown.
void BadLine::expect_little_ran_on() {
  if (result_.byte_changed) return;
  result_.ran_on = executed_.begun() - std::min(executed_.begun(), executed_at_abort_);
  const std::size_t most = line_.has_lost_xon() ? bound_.if_held : bound_.at_most;
  if (result_.ran_on > most)
    violate(fmt::format("{} bytes ran on after the abort, at most {} said", result_.ran_on, most));
}

void BadLine::expect_range_holds() {
  const std::uint64_t received = prepared_->of_body(job_arrived_);
  if (received < range_->least || range_->most < received) {
    violate(fmt::format("the mill received {} bytes, said are {} to {}", received, range_->least, range_->most));
  }
}

// Expects that no other job can be confirmed before a person has stated the outcome of this job, and that it can be
// afterwards.
void BadLine::expect_next_waits() {
  if (result_.violation) return;
  const jobs::JobState outcome = state();
  if (outcome == jobs::JobState::fed || outcome == jobs::JobState::paused_unknown) {
    expect_refused(confirm(kSecond), Reason::wrong_job_state, fmt::format("the job before is {}", name(outcome)));
    const bool ended = outcome == jobs::JobState::fed ? mill_.done(kFirst, kAtMill.who, bench_.now).has_value()
                                                      : mill_.cancel(kFirst, kAtMill.who, bench_.now).has_value();
    if (!ended) violate("a person cannot say what became of the job");
    states_[kFirst] = outcome;
  }
  if (!confirm(kSecond)) violate("the next job cannot be confirmed");
}

}  // namespace axisgate::rml1
