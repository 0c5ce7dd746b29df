// A device that is not a stage: the parts common to all devices need no axis controller.
#include "server/devices/device.h"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>

namespace axisgate::server::device_test {
namespace {

using std::chrono::seconds;

// A line that counts its starts and ends.
class CountedLine : public Line {
 public:
  struct Counts {
    int started = 0, ended = 0;
  };
  explicit CountedLine(Counts& counts) : counts_(counts) {}

  Opener opener() override { return {}; }
  const std::string& description() const override { return description_; }
  void start() override { ++counts_.started; }
  void shutdown() override { ++counts_.ended; }

 private:
  Counts& counts_;
  const std::string description_ = "/dev/usb/lp0";
};

class Lathe : public Device {
 public:
  Lathe(CountedLine::Counts& counts, LineThread& thread, Metrics& metrics, const Executor& readers, LeaseTokens& tokens)
      : Device("turning", {.device = "turning"}, std::make_unique<CountedLine>(counts), thread, metrics, readers,
               tokens, nullptr) {}

  std::string_view kind_name() const override { return "lathe"; }
  use::Scope whole() const override { return use::Scope::whole_device(); }
  void wind_down(std::function<void()> done) override {
    shutdown();
    done();
  }
  Duration wind_down_limit() const override { return seconds(3); }
};

class DeviceTest : public testing::Test {
 protected:
  LineThread thread_;  // never started
  Metrics metrics_;
  LeaseTokens tokens_{1};
  CountedLine::Counts line_;
  Lathe lathe_{line_, thread_, metrics_, [](const std::function<void()>& task) { task(); }, tokens_};
  Device& device_ = lathe_;
};

TEST_F(DeviceTest, SaysWhatItIs) {
  EXPECT_EQ(device_.name(), "turning");
  EXPECT_EQ(device_.kind_name(), "lathe");
  EXPECT_EQ(device_.line_description(), "/dev/usb/lp0");
  EXPECT_EQ(device_.wind_down_limit(), seconds(3));
}

TEST_F(DeviceTest, StartsAndEndsItsLine) {
  device_.start();
  EXPECT_EQ(line_.started, 1);
  bool done = false;
  device_.wind_down([&done] { done = true; });
  EXPECT_TRUE(done);
  EXPECT_EQ(line_.ended, 1);
}

TEST_F(DeviceTest, ItsLeasesAreSeenByReaders) {
  const TimePoint now{seconds(1)};
  EXPECT_EQ(device_.newest_leases().get().version, 0u);
  device_.leases().acquire({.scope = stage::AxisSet::first(3)}, "anna", false, now, now, [](const Result<Lease>&) {});
  const auto board = device_.newest_leases().get();
  ASSERT_EQ(board.value->held.size(), 1u);
  EXPECT_EQ(board.value->held[0].holder, "anna");
}

}  // namespace
}  // namespace axisgate::server::device_test
