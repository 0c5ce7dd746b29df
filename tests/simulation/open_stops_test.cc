// Tests that a stop stays open until it is confirmed: every kind of stop request, at every fault of the line. After the
// first line that is received after a fault, the stop is the next line written, and the axes become stationary within
// two exchanges and their deceleration. Every run prints one row of delays.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "tests/simulation/daemon.h"
#include "tests/simulation/scenario.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

enum class Way { stop, emergency, cancel, lease_lost, taken_over, jog_silence, at_exit, crash };
enum class Fault {
  cut_before,  // no line passes, and the port stays open; the stop is requested meanwhile
  cut_during,
  cut_after,
  reply_lost,
  garbage,
  reopened,
  killed,  // like cut_before, and the daemon is killed meanwhile
  restarted,
  another_unit
};
constexpr const char* kWays[] = {"stop",       "emergency",   "cancel",  "lease lost",
                                 "taken over", "jog silence", "at exit", "crash"};
constexpr const char* kFaults[] = {"cut before", "cut during", "cut after", "reply lost",  "garbage",
                                   "reopened",   "killed",     "restarted", "another unit"};

constexpr Duration kCut = milliseconds(2500);
// Q:SPC and its reply at 38400 baud with 64 bytes; the simulator decelerates in R = 100 ms and settles for 5 ms.
constexpr Duration kExchange = milliseconds(25), kDeceleration = milliseconds(105);

class OpenStops : public testing::TestWithParam<std::tuple<Way, Fault, bool>> {
 protected:
  OpenStops() {
    world_.on_news = [this](const Event& event) { on_event(event); };
    daemon_->prepare(world_.controller(), world_.now());
  }

  static Way way() { return std::get<0>(GetParam()); }
  static Fault fault() { return std::get<1>(GetParam()); }
  static bool all_axes() { return std::get<2>(GetParam()); }
  static AxisSet axes() { return all_axes() ? kAllAxes : AxisSet::of(1); }

  simulation::Setup with_leases() {
    simulation::Setup shared = quiet();
    shared.permission = &daemon_->leases();
    return shared;
  }

  void on_event(const Event& event) {
    daemon_->on_event(event, world_.now());
    if (const auto* received = std::get_if<BytesReceived>(&event)) {
      const bool line = received->bytes.find('\n') != std::string::npos;
      if (back_ && !heard_ && line) heard_ = {world_.now(), world_.wire().commands().size()};
    }
    const auto* changed = std::get_if<StopChanged>(&event);
    if (changed != nullptr && changed->stop.state == StopState::confirmed) ++confirmed_;
  }

  bool moves() {
    bool any = false;
    for (const int axis : axes().list()) any = any || world_.device().busy(axis);
    return any;
  }

  void start_motion() {
    RequestContext context = world_.context("anna");
    if (way() == Way::lease_lost || way() == Way::taken_over) {
      server::LeaseTerms terms;
      terms.scope = axes();
      daemon_->leases().acquire(terms, "anna", false, world_.now(), world_.now(),
                                [&](const Result<server::Lease>& lease) { context.lease = lease->token; });
    }
    lease_ = context.lease;
    if (way() == Way::jog_silence) {
      JogRequest jog{{}, context};
      for (const int axis : axes().list()) jog.axes.push_back({axis, 1, pulses(20'000)});
      jog_ = world_.controller().jog(std::move(jog), world_.now(), [](Result<Motion>) {});
    } else {
      MoveRequest move{{}, true, context};
      for (const int axis : axes().list()) move.moves.push_back({axis, pulses(1'900'000), {}});
      world_.controller().move(std::move(move), world_.now(), [](Result<Motion>) {});
    }
    for (int i = 0; i < 10; ++i) {
      world_.run_for(milliseconds(100));
      if (jog_ != 0) (void)world_.controller().renew_jog(jog_, {}, world_.now());
    }
    ASSERT_TRUE(moves()) << world_.replay();
  }

  void ask() {
    Controller& controller = world_.controller();
    const RequestContext by = world_.context("bert");
    const auto nothing = [](const StopReport&) {};
    switch (way()) {
      case Way::stop:
        return controller.stop(axes(), by, world_.now(), nothing);
      case Way::emergency:
        return controller.emergency_stop(by, world_.now(), nothing);
      case Way::cancel:
        return controller.cancel_motion(1, by, world_.now(), [](Result<void>) {});
      case Way::lease_lost:
        daemon_->leases().lost(lease_, world_.now());
        return controller.advance(world_.now());
      case Way::taken_over: {
        server::LeaseTerms terms;
        terms.scope = axes();
        daemon_->leases().take_over(terms, "admin", world_.now(), [](const Result<server::Lease>&) {});
        return controller.advance(world_.now());
      }
      case Way::jog_silence:
        return world_.run_for(milliseconds(500));  // no client renews it
      case Way::at_exit:
        return controller.wind_down(world_.now(), [this](const WindDownReport&) { ended_ = true; });
      case Way::crash:
        return;
    }
  }

  void kill(Duration away) {
    world_.restart_gateway({.start = [this]() -> Permission& {
                              daemon_ = nullptr;
                              daemon_ = std::make_unique<Daemon>(folder_, server::journal::MemoryBounds{}, ++run_);
                              return daemon_->leases();
                            },
                            .prepare = [this](Controller& controller) { daemon_->prepare(controller, world_.now()); },
                            .away = away});
  }

  // Loses lines in both directions for `time`; the port stays open.
  void cut(Duration time) {
    const TimePoint until = world_.now() + time;
    world_.wire().set_script([this, until](LineKind, const std::string&) {
      return Scripted{.drop = world_.now() < until, .delay = {}, .instead = {}};
    });
    world_.at(until, [this] { back_ = world_.now(); });
  }

  void change_first_reply(Scripted change) {
    world_.wire().set_script([this, change, done = false](LineKind kind, const std::string&) mutable -> Scripted {
      const bool stop = kind == LineKind::reply && world_.wire().commands().back().starts_with("L:");
      if (!stop || done) return {};
      done = true;
      back_ = world_.now();
      return change;
    });
  }

  void fail_and_ask() {
    switch (fault()) {
      case Fault::cut_before:
      case Fault::killed:
        cut(kCut);
        world_.run_for(milliseconds(300));
        ask();
        break;
      case Fault::cut_during:
      case Fault::cut_after:
        ask();
        world_.run_for(fault() == Fault::cut_during ? std::chrono::microseconds(600) : std::chrono::microseconds(1600));
        cut(kCut);
        break;
      case Fault::reply_lost:
        change_first_reply({.drop = true, .delay = {}, .instead = {}});
        ask();
        break;
      case Fault::garbage:
        change_first_reply({.drop = false, .delay = {}, .instead = "O\x83\r\n"});
        ask();
        break;
      case Fault::reopened:
        ask();
        world_.wire().cut(world_.now(), seconds(1));
        back_ = world_.now() + seconds(1);
        break;
      case Fault::restarted:
        cut(kCut);
        ask();
        world_.at(world_.now() + seconds(1), [this] { world_.power_cycle(); });
        break;
      case Fault::another_unit:
        world_.visit_of_another_unit("9999999999", milliseconds(200));
        ask();
        world_.run_for(kCut);
        world_.return_of_the_unit(milliseconds(200));
        back_ = world_.now();
        break;
    }
    const bool killed = fault() == Fault::killed || way() == Way::crash;
    if (killed) kill(milliseconds(500));
    if (way() != Way::at_exit) return;
    world_.run_until([this] { return ended_; }, seconds(12));
    kill(milliseconds(500));
  }

  StateFolder folder_;
  std::uint32_t run_ = 1;
  std::unique_ptr<Daemon> daemon_ = std::make_unique<Daemon>(folder_, server::journal::MemoryBounds{}, run_);
  World world_{with_leases()};
  server::LeaseToken lease_ = 0;
  stage::MotionId jog_ = 0;
  bool ended_ = false;
  int confirmed_ = 0;
  std::optional<TimePoint> back_;
  struct Heard {
    TimePoint at{};
    std::size_t lines = 0;  // lines written before
  };
  std::optional<Heard> heard_;
};

TEST_P(OpenStops, IsTheNextLineWrittenAndIsObeyed) {
  ASSERT_TRUE(world_.run_until_up()) << world_.replay();
  start_motion();
  fail_and_ask();
  ASSERT_TRUE(world_.run_until([this] { return heard_.has_value(); }, seconds(20))) << world_.replay();
  const bool moved = moves();
  ASSERT_TRUE(world_.run_until([this] { return !moves(); }, seconds(30))) << world_.replay();
  const Duration rest = world_.now() - heard_->at;
  if (moved) {
    const auto& lines = world_.wire().commands();
    ASSERT_GT(lines.size(), heard_->lines) << world_.replay();
    const bool asked_late = fault() == Fault::reply_lost || fault() == Fault::garbage;
    const bool next = lines[heard_->lines].starts_with("L:");
    EXPECT_TRUE(next || asked_late) << lines[heard_->lines] << "\n" << world_.replay();
    EXPECT_LE(rest, kDeceleration + 2 * kExchange) << world_.replay();
  }
  ASSERT_TRUE(world_.run_until([this] { return world_.controller().state().open_stops.empty(); }, seconds(60)))
      << world_.replay();
  const bool asked = way() != Way::crash || moved;  // a unit that was replaced meanwhile has forgotten the motion
  EXPECT_TRUE(confirmed_ > 0 || !asked) << world_.replay();
  EXPECT_FALSE(moves()) << world_.replay();
  EXPECT_TRUE(world_.violations().empty()) << world_.violations().front() << "\n" << world_.replay();
  fmt::print("| {} | {} | {} | {} | {:.0f} ms |\n", kWays[static_cast<int>(way())], kFaults[static_cast<int>(fault())],
             all_axes() ? 3 : 1, moved ? "moving" : "at rest",
             std::chrono::duration<double, std::milli>(moved ? rest : Duration{}).count());
}

INSTANTIATE_TEST_SUITE_P(Matrix, OpenStops,
                         testing::Combine(testing::Values(Way::stop, Way::emergency, Way::cancel, Way::lease_lost,
                                                          Way::taken_over, Way::jog_silence, Way::at_exit, Way::crash),
                                          testing::Values(Fault::cut_before, Fault::cut_during, Fault::cut_after,
                                                          Fault::reply_lost, Fault::garbage, Fault::reopened,
                                                          Fault::killed, Fault::restarted, Fault::another_unit),
                                          testing::Bool()));

}  // namespace
}  // namespace axisgate::simulation
