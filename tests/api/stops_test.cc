// Tests of stops of one device and of several devices, each with a separate result.
#include <gtest/gtest.h>

#include "tests/api/world.h"

namespace axisgate::api {
namespace {

// Fixture with three devices: "turn" and "table" are slow, and nothing answers on the line of "gone".
class StopsTest : public ::testing::Test {
 protected:
  // Starts the device's first motion, which lasts long.
  void start(const char* device) {
    Asking<StartedMotion> asking;
    world_.api->motions.move(World::by(kAnna), device, World::way_of(1'000'000), asking.answer());
    ASSERT_EQ(asking.reason(), Reason::unspecified) << device;
  }

  World world_{[](World& world) {
    world.device_text =
        "[[device]]\nname = \"table\"\nkind = \"rotor\"\nconnection = \"simulated\"\n"
        "[[device]]\nname = \"gone\"\nkind = \"rotor\"\nconnection = \"tcp\"\nhost = \"127.0.0.1\"\nport = 1\n";
  }};
};

// Every device that can be stopped is stopped, whatever happens to the others.
TEST_F(StopsTest, WithoutADeviceAllAreStopped) {
  start("devices/turn");
  start("devices/table");
  Asking<std::vector<DeviceStop>> asking;
  world_.api->stops.stop(World::by(kAnna), "", stage::AxisSet(), asking.answer());
  const auto stops = asking.get();
  ASSERT_TRUE(stops);
  ASSERT_EQ(stops->size(), 3u);
  const char* const names[] = {"turn", "table", "gone"};
  for (std::size_t i = 0; i < stops->size(); ++i) EXPECT_EQ((*stops)[i].device->name(), names[i]);
  for (const DeviceStop* one : {&(*stops)[0], &(*stops)[1]}) {
    EXPECT_FALSE(one->report.problem) << one->report.problem->message;
    ASSERT_EQ(one->report.axes.size(), 1u);
    EXPECT_EQ(one->report.axes[0].ready, true);
  }
  EXPECT_TRUE((*stops)[2].report.problem);
}

TEST_F(StopsTest, AsTheDaemonEndsEachClosedLineSaysSo) {
  for (const auto& device : world_.gateway->devices()) device->shutdown();
  Asking<std::vector<DeviceStop>> asking;
  world_.api->stops.stop(World::by(kAnna), "", stage::AxisSet(), asking.answer());
  const auto stops = asking.get();
  ASSERT_TRUE(stops);
  for (const DeviceStop& one : *stops) EXPECT_EQ(one.report.problem->reason, Reason::daemon_ending);
}

// The gateway does not guess which device the axes belong to.
TEST_F(StopsTest, AxesOfSeveralDevicesNeedTheirDevice) {
  Asking<std::vector<DeviceStop>> asking;
  world_.api->stops.stop(World::by(kAnna), "", stage::AxisSet::of(1), asking.answer());
  const auto refused = asking.get();
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().reason, Reason::invalid_request);
  EXPECT_NE(refused.error().hint.find("devices/turn, devices/table, devices/gone"), std::string::npos)
      << refused.error().hint;
  Asking<std::vector<DeviceStop>> named;
  world_.api->stops.stop(World::by(kAnna), "devices/table", stage::AxisSet::of(1), named.answer());
  EXPECT_EQ(named.reason(), Reason::unspecified);
}

TEST_F(StopsTest, AnEmergencyStopWithoutADeviceIsOfAll) {
  Asking<std::vector<DeviceStop>> asking;
  world_.api->stops.emergency_stop(World::by(kAnna), "", asking.answer());
  const auto stops = asking.get();
  ASSERT_TRUE(stops);
  EXPECT_EQ(stops->size(), 3u);
}

}  // namespace
}  // namespace axisgate::api
