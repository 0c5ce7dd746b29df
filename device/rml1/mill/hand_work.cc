#include "device/rml1/mill/hand_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <variant>

#include "device/rml1/sending/commands.h"

namespace axisgate::rml1 {
namespace {

long long seconds_until(TimePoint end, TimePoint now) {
  return std::chrono::ceil<std::chrono::seconds>(end - now).count();
}

}  // namespace

Result<void> HandWork::check_taken() const {
  if (abort_.phase() != AbortPhase::leaves && line_.unsent() == 0) return {};
  return fail(Reason::axis_busy, "the mill has not taken what it was sent before",
              "look at the mill: its panel may hold it, or it is off");
}

// A mill executes all bytes in order, so a job could be sent at once. But the pace of a job is computed for a mill that
// executes nothing else when the job starts. A job right after an abort is paced as if the tool were up already.
Result<void> HandWork::check_still(TimePoint now) const {
  const TimePoint done = done_by();
  if (done <= now) return {};
  return fail(Reason::axis_busy, "the mill may still do what it was sent by hand",
              fmt::format("ask again after {} s", seconds_until(done, now)));
}

// The tool rises after an abort. How much the mill executes before it obeys the abort is unknown; the answer to the
// abort says so.
Result<void> HandWork::check_risen(TimePoint now) const {
  const TimePoint risen = abort_.arrived_by() + longest_move(profile_.z_mm, profile_.speed.z_maximum, profile_, slack_);
  if (risen <= now) return {};
  return fail(Reason::axis_busy, "the tool may still rise after the abort",
              fmt::format("look at the mill, and ask again after {} s", seconds_until(risen, now)));
}

Result<void> HandWork::check_idle(TimePoint now) const {
  return check_taken().and_then([&] { return check_still(now); });
}

// A step must wait for the step before it, so that steps do not add up while nobody looks. Setting Z0 need not wait for
// a step: the mill sets it at the end of the step.
Result<void> HandWork::check(const jobs::HandAct& act, TimePoint now) const {
  if (const Result<void> taken = check_taken(); !taken) return taken;
  if (line_.held()) {
    return fail(Reason::axis_busy, "the mill takes nothing", "look at the mill: its panel may hold it, or it is off");
  }
  const auto* surface = std::get_if<jobs::SetZ0>(&act);
  const bool is_step = std::holds_alternative<jobs::JogStep>(act);
  if (is_step || (surface != nullptr && !surface->at)) {
    if (const Result<void> risen = check_risen(now); !risen) return risen;
  }
  return is_step ? check_still(now) : Result<void>();
}

Duration HandWork::write(const HandCommands& words, TimePoint now) {
  line_.write(words.bytes);
  done_at_ = std::max(done_by(), now) + words.longest;
  written_at_ = now;
  return done_at_ - now;
}

// An abort ends the acts before it. It may leave long after somebody requested it, but what leaves after it also
// arrives after it.
TimePoint HandWork::done_by() const {
  return written_at_ < abort_.left_at() ? std::min(done_at_, abort_.left_at()) : done_at_;
}

}  // namespace axisgate::rml1
