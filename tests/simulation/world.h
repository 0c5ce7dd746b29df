// The real controller core against the simulator, in virtual time, with callers who request various things. Everything
// follows from one seed, and all requirements are checked during the run.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "device/shrc203/controller.h"
#include "device/shrc203/simulator/simulator.h"
#include "tests/simulation/random.h"
#include "tests/simulation/wire.h"

namespace axisgate::simulation {

struct Setup {
  std::uint64_t seed = 1;
  Faults faults;
  int baud = 38400;
  shrc203::Profile profile;
  shrc203::simulator::Options options;
  stage::EventSink* listener = nullptr;   // receives every event too
  use::Permission* permission = nullptr;  // null: everybody may do everything
  bool followed = true;                   // false: the state of moves is rarely read while they run
  bool callers_send_bare_go = false;      // false: a bare G is taken for a fault of the gateway
};

// Returns a setup whose interpretations of the manual are drawn from the seed.
Setup drawn_setup(std::uint64_t seed, const Faults& faults);

class World : public stage::EventSink {
 public:
  explicit World(Setup setup);
  ~World() override;

  shrc203::Controller& controller() { return *controller_; }
  shrc203::simulator::Simulator& device() { return *device_; }
  Wire& wire() { return wire_; }
  Random& random() { return random_; }
  TimePoint now() const { return now_; }

  void run_for(Duration duration);
  // Runs until `done` holds. Returns false if `limit` passes first.
  bool run_until(const std::function<bool()>& done, Duration limit);
  bool run_until_up() {
    return run_until([this] { return controller_->state().link == stage::LinkState::up; }, std::chrono::seconds(60));
  }
  // Lets the host sleep: time passes, and bytes received meanwhile are handled first.
  void sleep_for(Duration duration) { now_ += duration; }
  // Runs the function at `when`, in the middle of any other event, even of a line.
  void at(TimePoint when, std::function<void()> deed) { operations_.emplace(when, std::move(deed)); }
  // Restarts the device. `silence` is the duration of its boot.
  void power_cycle(Duration silence = std::chrono::seconds(1));
  // Pulls the cable and puts it into another unit, and back at the return. During the visit only identity questions and
  // stops may be sent.
  void visit_of_another_unit(const std::string& serial_number, Duration unplugged_for);
  void return_of_the_unit(Duration unplugged_for);
  // Kills the daemon and starts another one. Must be called between two calls of the controller, for instance by at().
  struct Restart {
    std::function<use::Permission&()> start;  // starts the other daemon, once the controller is gone
    std::function<void(shrc203::Controller& controller)> prepare;  // before the line is opened
    Duration away{};                                               // until the line is opened
    bool written_is_lost = false;                                  // Wire::change_gateway()
  };
  void restart_gateway(const Restart& restart);
  void set_faults(const Faults& faults) { wire_.set_faults(faults); }

  use::RequestContext context(std::string who, Duration limit = std::chrono::seconds(20)) const {
    return {std::move(who), "", now_ + limit};
  }

  // Violations with their times; empty if there were none. The first one stops the run.
  const std::vector<std::string>& violations() const { return violations_; }
  void violation(const std::string& what);
  std::string replay() const;  // text to reproduce a failure
  Phase phase() const;

  void on_event(const stage::Event& event, TimePoint now) override;
  bool state_followed() const override { return setup_.followed; }
  const std::vector<stage::Motion>& outcomes() const { return outcomes_; }
  const std::vector<stage::PathProgress>& progress() const { return progress_; }
  const std::vector<stage::CompletionSeen>& completions() const { return completions_; }
  std::uint64_t exchanges() const { return exchanges_; }
  std::uint64_t barriers() const { return barriers_; }

  // Called with each motion event, for checks beyond those of the world.
  std::function<void(const stage::Motion&)> on_motion;
  // Called with every event.
  std::function<void(const stage::Event&)> on_news;

 private:
  void step(TimePoint limit);
  void check_exchange(const stage::ExchangeEnded& ended);
  void check_outcome(const stage::Motion& motion);
  void digest(const stage::Motion& motion);
  void swap_unit(const std::string& serial_number, Duration unplugged_for);
  std::int64_t told_position(int axis) const;
  bool restarting() const;
  bool told_before_restart() const;

  Setup setup_;
  Random random_;
  Wire wire_;
  std::unique_ptr<shrc203::simulator::Simulator> device_;
  std::unique_ptr<shrc203::Controller> controller_;
  std::optional<TimePoint> rebooted_;
  Duration restart_lasts_{};
  std::size_t written_before_reboot_ = 0;
  std::array<std::int64_t, shrc203::kAxisCount> before_reboot_{};
  TimePoint now_{};
  std::multimap<TimePoint, std::function<void()>> operations_;
  std::size_t written_when_last_ended_ = 0;  // number of commands when an exchange last ended
  std::size_t written_before_visit_ = 0;     // number of commands when another unit was connected
  int steps_here_ = 0;
  std::vector<std::string> violations_;
  std::vector<stage::Motion> outcomes_;
  std::vector<stage::PathProgress> progress_;
  std::vector<stage::CompletionSeen> completions_;
  std::uint64_t exchanges_ = 0, barriers_ = 0;
};

}  // namespace axisgate::simulation
