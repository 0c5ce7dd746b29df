// Several people and programs that use the stage at once, at random, and remember the answers that they received.
#pragma once

#include <string>
#include <vector>

#include "tests/simulation/mishaps.h"
#include "tests/simulation/world.h"

namespace axisgate::simulation {

struct Habits {
  bool shapes = false;          // they also draw curves, rest between segments, approach from one side, and scan
  bool stop_at_faults = false;  // a caller stops the stage at each fault of the line
};

class Callers {
 public:
  explicit Callers(World& world, std::uint64_t seed = 0, double mishaps_an_hour = 0, Habits habits = {});

  void act_for(Duration duration);
  // Makes the line perfect; every motion must then end and the device must answer.
  void become_stationary();

 private:
  void pass_time();
  void act();
  void move();
  void home();
  void path();
  void curved_path();
  void approach();
  void scan();
  void allow_starts(stage::AxisSet axes);
  void stop();
  void ask();
  void set_and_go();
  void check_starts();
  void check_answer(const std::string& question, const std::string& answer);

  World& world_;
  Mishaps mishaps_;
  const Habits habits_;
  std::array<int, shrc203::kAxisCount> starts_allowed_{};
  int unfinished_questions_ = 0;
};

}  // namespace axisgate::simulation
