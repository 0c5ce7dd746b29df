#include "server/gateway.h"

#include <gtest/gtest.h>
#include <termios.h>

#include <condition_variable>
#include <mutex>

#include "device/link/pty.h"
#include "server/kinds.h"
#include "tests/unit/link/link_fixtures.h"
#include "tests/unit/link/tcp_fixtures.h"

namespace axisgate::server::gateway_test {
namespace {

using link_test::kPatience;
using stage::LinkState;

DeviceConfig device_named(std::string name) {
  DeviceConfig device = default_config(device_kinds()).devices[0];
  device.name = std::move(name);
  return device;
}

stage::State state_of(const Gateway& gateway, std::string_view device) {
  return *gateway.find_stage(device)->newest_state().get().value;
}

// Waits until a condition that a device's strand brings about is true.
template <class Condition>
bool comes_true(Condition condition) {
  const TimePoint limit = monotonic_now() + kPatience;
  while (!condition()) {
    if (monotonic_now() > limit) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

// Consecutive questions, each sent after the previous answer.
class Questions {
 public:
  Questions(Stage& device, int count) : device_(device), left_(count) { ask(); }

  bool all_answered() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [this] { return left_ == 0; });
  }

 private:
  void ask() {
    device_.post([this](stage::StageController& controller, TimePoint now) {
      const use::RequestContext context{"tester", "", now + kPatience};
      controller.refresh(Duration::zero(), context, now, [this](const Result<stage::State>& state) {
        const std::lock_guard lock(mutex_);
        if (state) --left_;
        if (state && left_ > 0) ask();
        changed_.notify_all();
      });
    });
  }

  Stage& device_;
  std::mutex mutex_;
  std::condition_variable changed_;
  int left_;
};

// A tty whose other end takes no byte, as if flow control stopped it for ever.
class StuckTty {
 public:
  StuckTty() : pty_(open_pty(directory_ / "tty")), held_(::open((directory_ / "tty").c_str(), O_RDWR | O_NOCTTY)) {
    EXPECT_EQ(::tcflow(held_.get(), TCOOFF), 0);
  }
  std::string path() const { return directory_ / "tty"; }

 private:
  link_test::TemporaryDirectory directory_;
  Result<Pty> pty_;
  Descriptor held_;
};

TEST(Gateway, NoDeviceHoldsAnotherUp) {
  const StuckTty tty;
  const link_test::SilentHost host;
  DeviceConfig stuck = device_named("stuck"), silent = device_named("silent"), healthy = device_named("healthy");
  stuck.connection = SerialSettings{.path = tty.path()};
  silent.connection = host.settings();
  healthy.connection = SimulatedConnection{20, false, {}};
  Config config = default_config(device_kinds());
  config.devices = {silent, stuck, healthy};
  Gateway gateway(config, 1);
  gateway.start();

  ASSERT_TRUE(comes_true([&] { return state_of(gateway, "healthy").link == LinkState::up; }));
  EXPECT_TRUE(Questions(*gateway.find_stage("healthy"), 100).all_answered());
  EXPECT_EQ(state_of(gateway, "stuck").link, LinkState::connecting);
  EXPECT_EQ(state_of(gateway, "silent").link_problem, "") << "its first attempt was waited for";

  const auto stuck_said = [&] { return state_of(gateway, "stuck").link_problem; };
  EXPECT_TRUE(comes_true([&] { return stuck_said() == "no answer to three probes"; })) << stuck_said();
  EXPECT_TRUE(Questions(*gateway.find_stage("healthy"), 100).all_answered());
  const auto silent_said = [&] { return state_of(gateway, "silent").link_problem; };
  EXPECT_TRUE(comes_true([&] { return silent_said().starts_with("no answer from 127.0.0.1:"); })) << silent_said();
  EXPECT_TRUE(Questions(*gateway.find_stage("healthy"), 100).all_answered());
}

}  // namespace
}  // namespace axisgate::server::gateway_test
