// What befalls the device and its plug, at random: it restarts, somebody touches its front panel or a limit sensor, its
// cable is pulled. Whoever caused one also undoes it, as a person would.
#pragma once

#include <cstdint>
#include <functional>
#include <map>

#include "tests/simulation/world.h"

namespace axisgate::simulation {

class Mishaps {
 public:
  // Draws from numbers of its own, so that a run without mishaps is the same as one before there were any.
  Mishaps(World& world, std::uint64_t seed, double an_hour);

  // To be called every now and then; strikes when its time has come.
  void act();
  void undo_all();

 private:
  void strike();
  void put_right();
  void later(Duration after, std::function<void()> undo);

  World& world_;
  Random random_;
  double an_hour_;
  TimePoint last_{};
  std::multimap<TimePoint, std::function<void()>> undo_;
};

}  // namespace axisgate::simulation
