// MillController: what a person does with the mill besides jobs.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <variant>

#include "device/rml1/mill/mill_controller.h"

namespace axisgate::rml1 {

Result<void> MillController::check_taken() const {
  if (abort_.phase() != AbortPhase::leaves && line_.unsent() == 0) return {};
  return fail(Reason::axis_busy, "the mill has not taken what it was sent before",
              "look at the mill: its panel may hold it, or it is off");
}

// A mill executes what it is sent in this order. But a pace is computed from where nothing else moves.
Result<void> MillController::check_still(TimePoint now) const {
  if (by_hand_until_ <= now) return {};
  const auto left = std::chrono::ceil<std::chrono::seconds>(by_hand_until_ - now);
  return fail(Reason::axis_busy, "the mill may still do what it was sent by hand",
              fmt::format("ask again after {} s", left.count()));
}

// The tool rises after an abort. What a mill executes before it obeys, nobody knows: the answer to the abort says so.
Result<void> MillController::check_risen(TimePoint now) const {
  if (rises_until_ <= now) return {};
  const auto left = std::chrono::ceil<std::chrono::seconds>(rises_until_ - now);
  return fail(Reason::axis_busy, "the tool may still rise after the abort",
              fmt::format("look at the mill, and ask again after {} s", left.count()));
}

// Steps do not add up while nobody looks. Z0 after a step is set where the step leads.
Result<void> MillController::check_operable(const HandAct& act, TimePoint now) const {
  if (const Result<void> free = check_free(); !free) return free;
  if (const Result<void> taken = check_taken(); !taken) return taken;
  if (line_.held()) {
    return fail(Reason::axis_busy, "the mill takes nothing", "look at the mill: its panel may hold it, or it is off");
  }
  const auto* surface = std::get_if<SetSurface>(&act);
  const bool is_step = std::holds_alternative<JogStep>(act);
  if (is_step || (surface != nullptr && !surface->at)) {
    if (const Result<void> risen = check_risen(now); !risen) return risen;
  }
  return is_step ? check_still(now) : Result<void>();
}

// A job that continues the workpiece of another was checked with the heights of that one.
Result<void> MillController::check_surface(const Job& job) const {
  if (job.continues == 0 || job.setup.from || !waits_to_begin(job) || job.surfaces == surfaces_) return {};
  return fail(Reason::stale_setpoint,
              fmt::format("Z0 was sent to the mill since job {} began, and {} was checked on its workpiece",
                          job.continues, text_of(job)),
              "cancel the job, and send it without the one that it continues");
}

void MillController::set_surfaces(std::uint64_t surfaces) {
  surfaces_ = surfaces;
  events_.surface_set(surfaces_);
}

Result<Duration> MillController::operate(const HandAct& act, const stage::RequestContext& by, TimePoint now) {
  const Result<HandWords> words = words_of(act, profile_, settings_.sending.slack);
  if (!words) return tl::unexpected(words.error());
  if (const Result<void> can = check_operable(act, now); !can) return tl::unexpected(can.error());
  if (const Result<void> may = authorize(by, 0, now); !may) return tl::unexpected(may.error());
  setup_changed(fmt::format("{} had the mill {}", by.who, text_of(act)), now);
  noted_line_.write(words->bytes);
  if (std::holds_alternative<SetSurface>(act)) {
    set_surfaces(surfaces_ + 1);
    last_.leaves.surface = false;
    show_left();
  }
  by_hand_until_ = std::max(by_hand_until_, now) + words->longest;
  return by_hand_until_ - now;
}

}  // namespace axisgate::rml1
