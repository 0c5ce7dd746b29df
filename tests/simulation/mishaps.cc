#include "tests/simulation/mishaps.h"

namespace axisgate::simulation {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

Mishaps::Mishaps(World& world, std::uint64_t seed, double an_hour)
    : world_(world), random_(seed ^ 0x4D49534841505321u), an_hour_(an_hour) {}

void Mishaps::act() {
  const double hours = std::chrono::duration<double>(world_.now() - last_).count() / 3600;
  last_ = world_.now();
  while (!undo_.empty() && undo_.begin()->first <= world_.now()) undo_.extract(undo_.begin()).mapped()();
  if (random_.chance(hours * an_hour_)) strike();
}

void Mishaps::undo_all() {
  while (!undo_.empty()) undo_.extract(undo_.begin()).mapped()();
}

void Mishaps::later(Duration after, std::function<void()> undo) {
  undo_.emplace(world_.now() + after, std::move(undo));
}

void Mishaps::strike() {
  auto& device = world_.device();
  auto& wire = world_.wire();
  const int axis = static_cast<int>(random_.between(1, kAxisCount));
  const Duration while_it_lasts = milliseconds(random_.between(200, 8000));
  switch (random_.between(0, 9)) {
    case 0: {
      // Too short for a poll to be lost, or long enough for three probes.
      const Duration silence = milliseconds(random_.between(200, 2500));
      if (!wire.inject("device: reboot")) return;
      device.set_boot({.mode = random_.chance(0.2) ? "MANUAL" : "HOST", .silence = silence});
      world_.power_cycle(silence);
      return later(silence + while_it_lasts, [this] { world_.device().set_mode("HOST", world_.now()); });
    }
    case 1:
      if (!wire.inject("device: mode")) return;
      device.set_mode("MANUAL", world_.now());
      return later(while_it_lasts, [this] { world_.device().set_mode("HOST", world_.now()); });
    case 2:
      if (wire.inject("device: emergency")) device.press_emergency(world_.now());
      return later(while_it_lasts, [this] { put_right(); });
    case 3:
      if (wire.inject("device: excitation")) device.set_excitation(axis, false, world_.now());
      return later(while_it_lasts, [this, axis] { world_.device().set_excitation(axis, true, world_.now()); });
    case 4: {
      const int direction = random_.chance(0.5) ? 1 : -1;
      if (wire.inject("device: limit")) device.set_limit(axis, direction, true, world_.now());
      return later(while_it_lasts, [this, axis, direction] {
        world_.device().set_limit(axis, direction, false, world_.now());
        put_right();
      });
    }
    case 5:
      if (!wire.inject("device: dialect")) return;
      device.set_format("HIT", world_.now());
      return later(while_it_lasts, [this] { world_.device().set_format("SHOT_FC", world_.now()); });
    case 6:
      if (wire.inject("device: overflow")) device.set_error(axis, simulator::AxisError::overflow, true, world_.now());
      return later(while_it_lasts, [this] { put_right(); });
    case 7:
      // Within the reply limit: of a device that is slower for long, nobody can tell the old answers from the new.
      if (wire.inject("device: slow")) device.set_answer_delay(milliseconds(random_.between(20, 400)), world_.now());
      return later(while_it_lasts, [this] { world_.device().set_answer_delay({}, world_.now()); });
    case 8:
      if (wire.inject("device: stuck")) device.be_stuck(milliseconds(random_.between(100, 3000)), world_.now());
      return;
    default:
      if (wire.inject("link: unplugged")) wire.cut(world_.now(), while_it_lasts);
  }
}

// Somebody clears the error and excites the motors again.
void Mishaps::put_right() {
  for (int axis = 1; axis <= kAxisCount; ++axis) world_.device().set_excitation(axis, true, world_.now());
  world_.controller().clear_errors({}, world_.context("keeper"), world_.now(), [](Result<void>) {});
}

}  // namespace axisgate::simulation
