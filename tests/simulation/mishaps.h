// Random mishaps of the device and its plug: the device restarts, a person touches its front panel or a limit sensor,
// its cable is pulled or put into another unit. Each mishap is also undone later, as a person would do it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "tests/simulation/world.h"

namespace axisgate::simulation {

class Mishaps {
 public:
  // Causes mishaps while the world runs: at a drawn instant, at a drawn byte on the line, or at a byte of a set-and-go,
  // each equally often. Draws from a separate random sequence, so that a run without mishaps stays the same.
  Mishaps(World& world, std::uint64_t seed, double an_hour);

  // Undoes all mishaps and causes no more.
  void undo_all();

 private:
  void plan_next();
  void strike();
  void put_right();
  void later(Duration after, std::function<void()> undo);
  void undo_until(TimePoint now);
  Duration drawn(int least_ms, int most_ms) { return std::chrono::milliseconds(random_.between(least_ms, most_ms)); }

  void reboot();
  void leave_host();
  void other_dialect();
  void emergency();
  void excitation();
  void limit();
  void overflow() { error("device: overflow", shrc203::simulator::AxisError::overflow); }
  void scale() { error("device: scale", shrc203::simulator::AxisError::scale); }
  void disconnection() { error("device: disconnection", shrc203::simulator::AxisError::disconnection); }
  void error(const char* kind, shrc203::simulator::AxisError error);
  void fall_asleep();
  void slow();
  void stuck();
  void unplugged();
  void another_unit();
  void blocked_write();
  void stuck_line();

  World& world_;
  Random random_;
  double an_hour_;
  bool over_ = false, visited_ = false;
  int axis_ = 1;
  Duration lasts_{};
  std::multimap<TimePoint, std::function<void()>> undo_;
};

}  // namespace axisgate::simulation
