// Seeds with four users, emergency stops, cut cables and a killed daemon: nothing moves between an emergency stop and
// its clear. A separate ledger, which knows no latch of the gateway, decides when that is.
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>

#include "tests/simulation/daemon.h"
#include "tests/simulation/scenario.h"
#include "tests/simulation/seed_count.h"

namespace axisgate::simulation {
namespace {

using namespace shrc203;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kEmergencySeeds = 1000, kEmergencySeedsACase = 10, kDeedsOfFour = 60;

class FourUsers {
 public:
  explicit FourUsers(std::uint64_t seed)
      : random_(seed ^ 0x454D4552u), daemon_(new_daemon()), world_(with_leases(seed)) {
    world_.on_news = [this](const Event& event) { on_event(event); };
    daemon_->prepare(world_.controller(), world_.now());
  }

  void act() {
    world_.run_until_up();
    for (int i = 0; i < kDeedsOfFour && world_.violations().empty(); ++i) {
      deed();
      world_.run_for(milliseconds(random_.between(1, 700)));
    }
  }
  World& world() { return world_; }
  int emergencies() const { return emergencies_; }

 private:
  std::unique_ptr<Daemon> new_daemon() {
    return std::make_unique<Daemon>(folder_, server::journal::MemoryBounds{}, ++run_);
  }

  Setup with_leases(std::uint64_t seed) {
    Setup setup = drawn_setup(seed, *Faults::named(seed % 2 == 0 ? "mild" : "rough"));
    setup.permission = &daemon_->leases();
    return setup;
  }

  void on_event(const Event& event) {
    daemon_->on_event(event, world_.now());
    const auto* written = std::get_if<BytesWritten>(&event);
    if (written == nullptr || !latched_ || !starts_motion(written->bytes)) return;
    world_.violation("between an emergency stop and its clear this was sent: " + written->bytes);
  }

  std::string user() { return "user-" + std::to_string(random_.between(1, 4)); }

  void deed() {
    const auto drawn = random_.between(0, 99);
    if (drawn < 45) return move();
    if (drawn < 55) return jog();
    if (drawn < 65) return execute();
    if (drawn < 75) return emergency();
    if (drawn < 87) return clear();
    if (drawn < 93) return world_.wire().cut(world_.now(), milliseconds(random_.between(50, 3000)));
    if (drawn < 96) return kill();
    world_.controller().stop({}, world_.context(user()), world_.now(), [](const StopReport&) {});
  }

  void move() {
    MoveRequest request =
        move_of(world_, {{static_cast<int>(random_.between(1, 3)), random_.between(-9000, 9000)}}, true);
    request.context.who = user();
    world_.controller().move(std::move(request), world_.now(), [](Result<Motion>) {});
  }

  void jog() {
    JogRequest request{{{static_cast<int>(random_.between(1, 3)), 1, {}}}, world_.context(user())};
    (void)world_.controller().jog(std::move(request), world_.now(), [](Result<Motion>) {});
  }

  void execute() {
    world_.controller().execute({{"M:1+P500", "G:1"}, world_.context(user())}, world_.now(),
                                [](const ExecuteEvent&) {});
  }

  void emergency() {
    ++emergencies_;
    latched_ = true;
    ++asked_;
    world_.controller().emergency_stop(world_.context(user()), world_.now(), [](const StopReport&) {});
  }

  // Clears the errors. The latch ends if the call succeeds and no other emergency stop was requested since.
  void clear() {
    world_.controller().clear_errors({}, world_.context("admin"), world_.now(),
                                     [this, asked = asked_](const Result<void>& done) {
                                       if (done && asked == asked_) latched_ = false;
                                     });
  }

  void kill() {
    world_.restart_gateway({.start = [this]() -> Permission& {
                              daemon_.reset();
                              daemon_ = new_daemon();
                              return daemon_->leases();
                            },
                            .prepare = [this](Controller& controller) { daemon_->prepare(controller, world_.now()); },
                            .away = milliseconds(random_.between(10, 1500)),
                            .written_is_lost = random_.chance(0.5)});
  }

  Random random_;
  StateFolder folder_;
  std::uint32_t run_ = 0;
  std::unique_ptr<Daemon> daemon_;
  World world_;
  bool latched_ = false;
  int emergencies_ = 0, asked_ = 0;
};

// Returns the number of requested emergency stops.
int hold_with_four(std::uint64_t seed) {
  FourUsers users(seed);
  users.act();
  EXPECT_TRUE(users.world().violations().empty()) << users.world().violations().front() << "\n"
                                                  << users.world().replay();
  return users.emergencies();
}

class EmergencySeeds : public testing::TestWithParam<int> {};

TEST_P(EmergencySeeds, NobodyMovesBeforeItIsCleared) {
  if (const char* only = std::getenv("AXISGATE_SEED")) {
    if (GetParam() == 0) (void)hold_with_four(std::strtoull(only, nullptr, 10));
    return;
  }
  const int last = seed_count(kEmergencySeeds);
  const int first = GetParam() * kEmergencySeedsACase;
  int emergencies = 0;
  for (int seed = first; seed < std::min(first + kEmergencySeedsACase, last) && !HasFailure(); ++seed) {
    emergencies += hold_with_four(static_cast<std::uint64_t>(seed));
  }
  EXPECT_TRUE(emergencies > 0 || last < first + kEmergencySeedsACase) << "these seeds show nothing";
}

INSTANTIATE_TEST_SUITE_P(Ordinary, EmergencySeeds,
                         testing::Range(0, seed_cases(kEmergencySeeds, kEmergencySeedsACase)));

}  // namespace
}  // namespace axisgate::simulation
