// The real controller core against the simulator, in virtual time, with callers who ask for this and that. Everything
// follows from one seed; what must hold is checked as it happens.
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
  stage::EventSink* listener = nullptr;     // receives every event too
  stage::Permission* permission = nullptr;  // none: everybody may
  bool followed = true;                     // else moves are seldom looked at on their way
  bool callers_send_bare_go = false;        // else a bare G is taken for a fault of the gateway's own
};

// A setup whose open questions are drawn from the seed.
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
  // Runs until `done` holds; false when `limit` passed first.
  bool run_until(const std::function<bool()>& done, Duration limit);
  bool run_until_up() {
    return run_until([this] { return controller_->state().link == stage::LinkState::up; }, std::chrono::seconds(60));
  }
  // The host sleeps: time has passed, and what came meanwhile comes first.
  void sleep_for(Duration duration) { now_ += duration; }
  // Runs the function at that time, in the middle of whatever happens then, even of a line.
  void at(TimePoint when, std::function<void()> deed) { operations_.emplace(when, std::move(deed)); }
  void power_cycle(Duration silence = std::chrono::seconds(1));  // as long as the device's boot is set to last
  // The cable is pulled and put into another unit, and back at its return. While it visits, only its identity may be
  // asked, and only a stop may be sent.
  void visit_of_another_unit(const std::string& serial_number, Duration unplugged_for);
  void return_of_the_unit(Duration unplugged_for);
  // The daemon is killed, and another one is started. To be called between two calls of the controller, as by at().
  struct Restart {
    std::function<stage::Permission&()> start;                     // the other daemon, when the controller is gone
    std::function<void(shrc203::Controller& controller)> prepare;  // before the line is opened
    Duration away{};                                               // until it is
    bool written_is_lost = false;                                  // Wire::change_gateway()
  };
  void restart_gateway(const Restart& restart);
  void set_faults(const Faults& faults) { wire_.set_faults(faults); }

  stage::RequestContext context(std::string who, Duration limit = std::chrono::seconds(20)) const {
    return {std::move(who), "", now_ + limit};
  }

  // What was wrong, with its time; empty when nothing was. The first stops the run.
  const std::vector<std::string>& violations() const { return violations_; }
  void violation(const std::string& what);
  std::string replay() const;  // how to see a failure again
  Phase phase() const;

  void on_event(const stage::Event& event, TimePoint now) override;
  bool state_followed() const override { return setup_.followed; }
  const std::vector<stage::Motion>& outcomes() const { return outcomes_; }
  const std::vector<stage::PathProgress>& progress() const { return progress_; }
  const std::vector<stage::CompletionSeen>& completions() const { return completions_; }
  std::uint64_t exchanges() const { return exchanges_; }
  std::uint64_t barriers() const { return barriers_; }

  // Called with each motion event, to watch more than the world itself does.
  std::function<void(const stage::Motion&)> on_motion;
  // The same of every event.
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
  std::array<std::int64_t, stage::kAxisCount> before_reboot_{};
  TimePoint now_{};
  std::multimap<TimePoint, std::function<void()>> operations_;
  std::size_t written_when_last_ended_ = 0;  // commands, when an exchange last ended
  std::size_t written_before_visit_ = 0;     // commands, when another unit came
  int steps_here_ = 0;
  std::vector<std::string> violations_;
  std::vector<stage::Motion> outcomes_;
  std::vector<stage::PathProgress> progress_;
  std::vector<stage::CompletionSeen> completions_;
  std::uint64_t exchanges_ = 0, barriers_ = 0;
};

}  // namespace axisgate::simulation
