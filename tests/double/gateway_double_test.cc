// Tests of the gateway with a second kind of device, which is known to server/ only by one line in the list of kinds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>
#include <thread>
#include <vector>

#include "device/link/clock.h"
#include "server/gateway.h"
#include "server/kinds.h"
#include "tests/double/kind.h"

namespace axisgate::server {
namespace {

using stage::LinkState;
using stage::MotionState;
using testing::HasSubstr;

constexpr std::chrono::seconds kPatience{10};

std::vector<const stage::Kind*> kinds_with_rotor() {
  const auto known = device_kinds().stages;
  std::vector<const stage::Kind*> kinds(known.begin(), known.end());
  kinds.push_back(&rotor::kind());
  return kinds;
}

Configured<Config> parse(const std::string& device) {
  static const std::vector<const stage::Kind*> kinds = kinds_with_rotor();
  return parse_config("[[device]]\nname = \"turn\"\nconnection = \"simulated\"\n" + device, "double.toml",
                      {.stages = kinds});
}

std::string first_error(const Configured<Config>& config) {
  return config || config.error().empty() ? "" : to_string(config.error().front());
}

// Waits for a condition that a device's strand makes true.
template <class Condition>
bool comes_true(Condition condition) {
  const TimePoint limit = monotonic_now() + kPatience;
  while (!condition()) {
    if (monotonic_now() > limit) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

class RunningGateway {
 public:
  explicit RunningGateway(const Config& config) : gateway_(config, 1) { gateway_.start(); }

  bool is_up() {
    return comes_true([this] { return state().link == LinkState::up; });
  }
  stage::State state() { return *device().newest_state().get().value; }
  Stage& device() { return *gateway_.find_stage("turn"); }

  // Starts a move and returns it with its outcome; its state is queued if it has no outcome.
  stage::Motion outcome_of_move(Quantity distance) {
    device().post([this, distance](stage::StageController& controller, TimePoint now) {
      controller.move({{{.axis = 1, .distance = distance, .profile = {}}}, false, {.who = "tester"}}, now,
                      [this](const Result<stage::Motion>& started) {
                        const std::lock_guard lock(mutex_);
                        if (started) motion_ = *started;
                        answered_ = true;
                      });
    });
    const bool ended = comes_true([this] { return answered() && look(); });
    EXPECT_TRUE(ended);
    const std::lock_guard lock(mutex_);
    return motion_;
  }

  bool wind_down() {
    gateway_.wind_down([this] {
      const std::lock_guard lock(mutex_);
      wound_down_ = true;
    });
    return comes_true([this] {
      const std::lock_guard lock(mutex_);
      return wound_down_;
    });
  }

 private:
  bool answered() {
    const std::lock_guard lock(mutex_);
    return answered_;
  }
  bool look() {
    device().post([this](stage::StageController& controller, TimePoint) {
      const std::lock_guard lock(mutex_);
      if (const auto motion = controller.find_motion(motion_.id)) motion_ = *motion;
    });
    const std::lock_guard lock(mutex_);
    return is_outcome(motion_.state) || motion_.id == 0;
  }

  std::mutex mutex_;
  stage::Motion motion_;
  bool answered_ = false, wound_down_ = false;
  Gateway gateway_;
};

TEST(GatewayWithRotor, MovesIt) {
  const auto config = parse("kind = \"rotor\"\nspeed = 20\n[[device.axis]]\nnumber = 1\nunit = \"deg\"\n");
  ASSERT_TRUE(config) << first_error(config);
  RunningGateway gateway(*config);
  ASSERT_TRUE(gateway.is_up());
  EXPECT_EQ(gateway.device().kind().name(), "rotor");
  EXPECT_EQ(gateway.state().model, "ROTOR");
  const stage::Motion motion = gateway.outcome_of_move({{90, 0}, Unit::degrees});
  EXPECT_EQ(motion.state, MotionState::succeeded);
  EXPECT_EQ(motion.results.at(0).command_pulses, 36'000);
  EXPECT_TRUE(comes_true([&] { return gateway.state().axis(1).position_pulses == 36'000; }));
  EXPECT_TRUE(gateway.wind_down());
}

TEST(GatewayWithRotor, TurnsItTheOtherWay) {
  const auto config = parse("kind = \"rotor\"\ndirection = \"reversed\"\nspeed = 20\noptions = { speed = \"1000\" }\n");
  ASSERT_TRUE(config) << first_error(config);
  EXPECT_EQ(std::get<StageConfig>(config->devices[0].family).kind_settings.at("direction"), "reversed");
  std::mutex mutex;
  std::string told;
  RunningGateway gateway(*config);
  ASSERT_TRUE(gateway.is_up());
  const stage::Motion motion = gateway.outcome_of_move(pulses(-700));
  EXPECT_EQ(motion.state, MotionState::succeeded);
  gateway.device().line().operate("position", [&](const Result<std::string>& answer) {
    const std::lock_guard lock(mutex);
    told = answer.value_or("refused");
  });
  EXPECT_TRUE(comes_true([&] {
    const std::lock_guard lock(mutex);
    return told == "700 pulses, standing";
  }));
  EXPECT_TRUE(gateway.wind_down());
}

TEST(GatewayWithRotor, TellsWhichKindsThereAre) {
  EXPECT_THAT(first_error(parse("kind = \"mill\"\n")),
              HasSubstr("\"mill\" is not known; use one of \"shrc203\", \"rotor\""));
}

TEST(GatewayWithRotor, EachKindHasItsOwnSettings) {
  EXPECT_THAT(first_error(parse("kind = \"rotor\"\nbusy_scope = \"axis\"\n")), HasSubstr("device.busy_scope"));
  EXPECT_THAT(first_error(parse("kind = \"shrc203\"\ndirection = \"normal\"\n")), HasSubstr("device.direction"));
  EXPECT_THAT(first_error(parse("kind = \"rotor\"\ndirection = \"up\"\n")),
              HasSubstr("\"up\" is not known; use one of \"normal\", \"reversed\""));
  EXPECT_THAT(first_error(parse("kind = \"rotor\"\noptions = { colour = \"red\" }\n")),
              HasSubstr("speed, place or serial_number"));
}

}  // namespace
}  // namespace axisgate::server
