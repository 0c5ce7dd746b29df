#include "tests/simulation/mishaps.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace axisgate::simulation {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

namespace {

// Maximum number of bytes for which a mishap waits.
constexpr int kBytesAhead = 600;
constexpr int kBytesOfSetAndGo = 40;
constexpr const char* kOtherUnit = "9999999999";

}  // namespace

Mishaps::Mishaps(World& world, std::uint64_t seed, double an_hour)
    : world_(world), random_(seed ^ 0x4D49534841505321u), an_hour_(an_hour) {
  if (an_hour_ > 0) plan_next();
}

void Mishaps::plan_next() {
  const std::int64_t mean_ms = std::max<std::int64_t>(1, static_cast<std::int64_t>(3'600'000 / an_hour_));
  const Duration pause = milliseconds(random_.between(1, 2 * mean_ms));
  const auto moment = random_.between(0, 2);
  const bool of_set_and_go = moment == 2;
  const auto bytes = static_cast<std::uint64_t>(random_.between(1, of_set_and_go ? kBytesOfSetAndGo : kBytesAhead));
  world_.at(world_.now() + pause, [this, moment, of_set_and_go, bytes] {
    if (moment == 0) return strike();
    world_.wire().after_bytes(bytes, of_set_and_go, [this](TimePoint at) { world_.at(at, [this] { strike(); }); });
  });
}

void Mishaps::undo_all() {
  over_ = true;
  undo_until(TimePoint::max());
}

void Mishaps::undo_until(TimePoint now) {
  while (!undo_.empty() && undo_.begin()->first <= now) undo_.extract(undo_.begin()).mapped()();
}

void Mishaps::later(Duration after, std::function<void()> undo) {
  undo_.emplace(world_.now() + after, std::move(undo));
  world_.at(world_.now() + after, [this] { undo_until(world_.now()); });
}

void Mishaps::strike() {
  if (over_) return;
  using Operation = void (Mishaps::*)();
  static const std::vector<Operation> deeds = {
      &Mishaps::reboot,     &Mishaps::leave_host, &Mishaps::other_dialect, &Mishaps::emergency,
      &Mishaps::excitation, &Mishaps::limit,      &Mishaps::overflow,      &Mishaps::scale,
      &Mishaps::slow,       &Mishaps::stuck,      &Mishaps::disconnection, &Mishaps::fall_asleep,
      &Mishaps::unplugged,  &Mishaps::stuck_line, &Mishaps::blocked_write, &Mishaps::another_unit};
  axis_ = static_cast<int>(random_.between(1, kAxisCount));
  lasts_ = drawn(200, 8000);
  (this->*random_.pick(deeds))();
  plan_next();
}

void Mishaps::reboot() {
  // Too short for a poll to be lost, or long enough for three probes.
  const Duration silence = drawn(200, 2500);
  const char* mode = random_.chance(0.2) ? "MANUAL" : "HOST";
  if (!world_.wire().inject("device: reboot")) return;
  world_.device().set_boot({.mode = mode, .silence = silence});
  world_.power_cycle(silence);
  later(silence + lasts_, [this] { world_.device().set_mode("HOST", world_.now()); });
}

void Mishaps::leave_host() {
  if (!world_.wire().inject("device: mode")) return;
  world_.device().set_mode("MANUAL", world_.now());
  later(lasts_, [this] { world_.device().set_mode("HOST", world_.now()); });
}

void Mishaps::other_dialect() {
  if (!world_.wire().inject("device: dialect")) return;
  world_.device().set_format("HIT", world_.now());
  later(lasts_, [this] { world_.device().set_format("SHOT_FC", world_.now()); });
}

void Mishaps::emergency() {
  if (!world_.wire().inject("device: emergency")) return;
  world_.device().press_emergency(world_.now());
  later(lasts_, [this] { put_right(); });
}

void Mishaps::excitation() {
  if (!world_.wire().inject("device: excitation")) return;
  world_.device().set_excitation(axis_, false, world_.now());
  later(lasts_, [this, axis = axis_] { world_.device().set_excitation(axis, true, world_.now()); });
}

void Mishaps::limit() {
  const int direction = random_.chance(0.5) ? 1 : -1;
  if (!world_.wire().inject("device: limit")) return;
  world_.device().set_limit(axis_, direction, true, world_.now());
  later(lasts_, [this, axis = axis_, direction] {
    world_.device().set_limit(axis, direction, false, world_.now());
    put_right();
  });
}

void Mishaps::error(const char* kind, simulator::AxisError error) {
  if (!world_.wire().inject(kind)) return;
  world_.device().set_error(axis_, error, true, world_.now());
  later(lasts_, [this, axis = axis_, error] {
    world_.device().set_error(axis, error, false, world_.now());
    put_right();
  });
}

// Puts the controller to sleep, unless an axis moves, because it then accepts no sleep.
void Mishaps::fall_asleep() {
  for (int axis = 1; axis <= kAxisCount; ++axis) {
    if (world_.device().busy(axis)) return;
  }
  if (!world_.wire().inject("device: sleep")) return;
  (void)world_.device().set_sleep(true, world_.now());
  later(lasts_, [this] { (void)world_.device().set_sleep(false, world_.now()); });
}

// Delays answers within the reply limit. If a device stays slower than that, old and new answers cannot be
// distinguished.
void Mishaps::slow() {
  const Duration delay = drawn(20, 400);
  if (!world_.wire().inject("device: slow")) return;
  world_.device().set_answer_delay(delay, world_.now());
  later(lasts_, [this] { world_.device().set_answer_delay({}, world_.now()); });
}

void Mishaps::stuck() {
  const Duration time = drawn(100, 3000);
  if (world_.wire().inject("device: stuck")) world_.device().be_stuck(time, world_.now());
}

void Mishaps::unplugged() {
  if (world_.wire().inject("link: unplugged")) world_.wire().cut(world_.now(), lasts_);
}

// Puts the cable into another unit, and back later. Only questions may be sent to that unit.
void Mishaps::another_unit() {
  const Duration away = drawn(50, 3000);
  const bool unit_known = world_.controller().state().device_epoch > 0;
  if (!unit_known || visited_) return;
  if (!world_.wire().inject("link: another unit")) return;
  visited_ = true;
  world_.visit_of_another_unit(kOtherUnit, away);
  later(lasts_ + away, [this, away] {
    visited_ = false;
    world_.return_of_the_unit(away);
  });
}

void Mishaps::blocked_write() {
  const Duration time = drawn(20, 3000);
  if (world_.wire().inject("link: blocked write")) world_.wire().hold_up(true, time);
}

void Mishaps::stuck_line() {
  const Duration time = drawn(20, 3000);
  if (world_.wire().inject("line: stuck")) world_.wire().hold_up(false, time);
}

// Clears the error and excites the motors again, like a person.
void Mishaps::put_right() {
  for (int axis = 1; axis <= kAxisCount; ++axis) world_.device().set_excitation(axis, true, world_.now());
  world_.controller().clear_errors({}, world_.context("keeper"), world_.now(), [](Result<void>) {});
}

}  // namespace axisgate::simulation
