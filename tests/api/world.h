// Gateway with one simulated rotor, and its Api: no gRPC, no SHRC-203.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "device/link/clock.h"
#include "server/api/api.h"
#include "server/config/access.h"
#include "server/events/wall_time.h"
#include "tests/double/kind.h"

namespace axisgate::api {

inline constexpr std::chrono::seconds kTestPatience{20};
inline constexpr const char* kDevice = "devices/turn";
inline constexpr const char* kAdmin = "unix root";
inline constexpr const char* kAnna = "unix anna";  // has the role operator

// Waits for a condition that another thread makes true. Returns false if it stays false for kTestPatience.
template <class Condition>
bool comes_true(Condition condition) {
  const TimePoint limit = monotonic_now() + kTestPatience;
  while (!condition()) {
    if (monotonic_now() > limit) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

// An Asking waits for the answer to one request.
template <class Outcome>
class Asking {
 public:
  Answer<Outcome> answer() {
    return [promise = promise_](Result<Outcome> outcome) { promise->set_value(std::move(outcome)); };
  }
  bool answered() { return future_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
  Result<Outcome> get() {
    if (future_.wait_for(kTestPatience) == std::future_status::ready) return future_.get();
    return fail(Reason::internal, "the test has had no answer");
  }
  // Waits for the answer and returns the reason of the refusal; unspecified if the request was done.
  Reason reason() {
    const Result<Outcome> outcome = get();
    return outcome ? Reason::unspecified : outcome.error().reason;
  }

 private:
  std::shared_ptr<std::promise<Result<Outcome>>> promise_ = std::make_shared<std::promise<Result<Outcome>>>();
  std::future<Result<Outcome>> future_ = promise_->get_future();
};

// A Reader reads a stream, one item whenever the test asks for it.
template <class Item>
class Reader {
 public:
  explicit Reader(std::shared_ptr<Subscription<Item>> subscription) : subscription_(std::move(subscription)) {
    subscription_->open([woken = woken_] {
      const std::lock_guard lock(woken->mutex);
      ++woken->count;
      woken->changed.notify_all();
    });
  }
  ~Reader() { close(); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  // Returns the next item; nullopt at the end of the stream.
  std::optional<Item> next() {
    const TimePoint limit = monotonic_now() + kTestPatience;
    while (monotonic_now() < limit) {
      const int before = wake_ups();
      auto reading = subscription_->next();
      if (auto* item = std::get_if<Item>(&reading)) return std::move(*item);
      if (auto* end = std::get_if<StreamEnd>(&reading)) {
        end_ = *end;
        return std::nullopt;
      }
      wait(before);
    }
    ADD_FAILURE() << "the stream has nothing to say";
    end_ = StreamEnd{Problem{.reason = Reason::internal}};
    return std::nullopt;
  }
  // Reads to the end and returns the reason; unspecified if the stream ended in order.
  Reason reason() {
    while (next()) {
    }
    return end_->problem ? end_->problem->reason : Reason::unspecified;
  }
  const StreamEnd& end() const { return *end_; }
  // Reports whether an item or the end is available without waiting. Consumes it.
  bool has_something() { return !std::holds_alternative<typename Subscription<Item>::Nothing>(subscription_->next()); }
  int wake_ups() const {
    const std::lock_guard lock(woken_->mutex);
    return woken_->count;
  }
  void close() {
    if (!std::exchange(closed_, true)) subscription_->close();
  }

 private:
  struct Woken {
    std::mutex mutex;
    std::condition_variable changed;
    int count = 0;
  };
  void wait(int before) {
    std::unique_lock lock(woken_->mutex);
    woken_->changed.wait_for(lock, std::chrono::milliseconds(50), [&] { return woken_->count != before; });
  }

  const std::shared_ptr<Subscription<Item>> subscription_;
  const std::shared_ptr<Woken> woken_ = std::make_shared<Woken>();
  std::optional<StreamEnd> end_;
  bool closed_ = false;
};

// A World is a gateway in which local callers are operators, except the observer "unix olaf".
class World {
 public:
  // `configure` sets access_config, limits, journal_config and device_text.
  explicit World(const std::function<void(World&)>& configure = {}) {
    access_config.admin_commands = server::admin_commands(kinds());
    access_config.roles = {{"unix olaf", server::Role::observer}};
    if (configure) configure(*this);
    start();
  }
  ~World() {
    end();
    std::filesystem::remove_all(directory);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;

  // Restarts the daemon with its stored data. Needs a journal. If `in_order` is false, the daemon appears to have been
  // killed.
  void restart(bool in_order) {
    if (in_order) journal->append({{.kind = server::journal::EntryKind::daemon_ended}});
    end();
    start();
  }

  static Call by(const std::string& who) { return {.credential = {.who = who}}; }

  server::Stage& device() { return *gateway->find_stage("turn"); }
  stage::State state() { return *device().newest_state().get().value; }

  // Runs a task on the device's strand, and waits for its end.
  template <class Task>
  void on_strand(Task task) {
    std::promise<void> done;
    device().post([&](stage::StageController& controller, TimePoint now) {
      task(controller, now);
      done.set_value();
    });
    done.get_future().wait();
  }

  // Acquires a lease over all axes and returns its token; 0 if it was not granted at once.
  server::LeaseToken lease_of(const std::string& who) {
    // The callback may run after this function has returned, when another lease ends.
    const auto token = std::make_shared<std::atomic<server::LeaseToken>>(0);
    on_strand([&](stage::StageController&, TimePoint now) {
      device().leases().acquire({.scope = stage::AxisSet::first(3)}, who, false, now, now,
                                [token](const Result<server::Lease>& lease) { *token = lease ? lease->token : 0; });
    });
    return *token;
  }

  std::string sealed(server::LeaseToken token) const { return gateway->lease_tokens().seal(token); }

  // Lets another caller stop a motion of `who`, so that `who` cannot move until rearm.
  void latch(const std::string& who) {
    on_strand([&](stage::StageController&, TimePoint now) {
      constexpr stage::MotionId kNobodysMotion = 1'000'000;
      const auto axes = stage::AxisSet::first(3);
      device().leases().begin({who, 0, axes, kNobodysMotion}, {}, now);
      device().leases().stop_asked({"unix eve", 0, axes, 0}, {}, now);
      device().leases().end(kNobodysMotion, now);
    });
  }

  std::vector<stage::Motion> motions() {
    std::vector<stage::Motion> all;
    on_strand([&](stage::StageController& controller, TimePoint) { all = controller.motions(); });
    return all;
  }
  bool all_ended() {
    return comes_true([&] {
      for (const stage::Motion& motion : motions()) {
        if (!is_outcome(motion.state)) return false;
      }
      return true;
    });
  }

  // Creates a token with this role; empty if it was refused.
  std::string token(const std::string& name, server::Role role) {
    const server::Calendar now = server::calendar_now();
    return access->tokens().create(name, role, now + std::chrono::hours(1), now).value_or("");
  }

  static Scan scan() {
    Scan scan{.request = {}, .interval = pulses(2)};
    scan.request.axis = 1;
    return scan;
  }
  static Move way_of(std::int64_t way) { return {{{.axis = 1, .distance = pulses(way)}}, true}; }
  StartedMotion move(const Call& call, std::int64_t way) {
    Asking<StartedMotion> asking;
    api->motions.move(call, kDevice, way_of(way), asking.answer());
    return asking.get().value_or(StartedMotion());
  }
  Reason reason_of_move(const Call& call, std::int64_t way = 10) {
    Asking<StartedMotion> asking;
    api->motions.move(call, kDevice, way_of(way), asking.answer());
    return asking.reason();
  }

  const std::string directory = ::testing::TempDir() + "axisgate-api-" + std::to_string(::getpid());
  server::AccessConfig access_config;
  server::LimitsConfig limits;
  server::JournalConfig journal_config{.kept = false};
  std::string device_text = "speed = 20\n";  // factor by which the simulation is faster than real time
  std::unique_ptr<server::Access> access;
  std::unique_ptr<server::SavedPositions> positions;
  std::unique_ptr<server::journal::Journal> journal;  // null: no journal
  std::unique_ptr<server::Gateway> gateway;
  std::unique_ptr<Api> api;

 private:
  static server::DeviceKinds kinds() {
    static const std::vector<const stage::Kind*> only = {&rotor::kind()};
    return {.stages = only};
  }
  void end() {
    api.reset();
    gateway.reset();
    journal.reset();
  }
  void start() {
    std::filesystem::create_directories(directory);
    const std::string text =
        "[[device]]\nname = \"turn\"\nkind = \"rotor\"\nconnection = \"simulated\"\n" + device_text;
    auto config = server::parse_config(text, "api.toml", kinds());
    ASSERT_TRUE(config) << to_string(config.error().front());
    config->limits = limits;
    config->journal = journal_config;
    if (journal_config.kept) journal = *server::journal::Journal::open(directory + "/journal.sqlite");
    access = std::make_unique<server::Access>(access_config, kAdmin, *server::Tokens::open(directory + "/tokens"));
    positions = *server::SavedPositions::open(directory + "/positions");
    gateway = std::make_unique<server::Gateway>(*config, 1, "", journal.get());
    if (journal) journal->append({{.kind = server::journal::EntryKind::daemon_started}});
    api = std::make_unique<Api>(*gateway, *access, *positions);
    gateway->start();
    ASSERT_TRUE(comes_true([this] { return state().link == stage::LinkState::up; }));
  }
};

}  // namespace axisgate::api
