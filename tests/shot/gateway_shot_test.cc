// The gateway with a stage of two axes: the configuration, leases and stops know how many there are.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <thread>
#include <vector>

#include "device/link/clock.h"
#include "server/gateway.h"
#include "tests/shot/kind.h"

namespace axisgate::server {
namespace {

using testing::HasSubstr;

Configured<Config> parse(const std::string& device) {
  static const std::vector<const stage::Kind*> kinds = {&shot2::kind()};
  return parse_config("[[device]]\nname = \"table\"\nkind = \"shot2\"\nconnection = \"simulated\"\n" + device,
                      "shot.toml", {.stages = kinds});
}

TEST(GatewayWithShot2, HasItsTwoAxes) {
  const auto config = parse("[[device.axis]]\nnumber = 2\nunit = \"mm\"\n");
  ASSERT_TRUE(config);
  Gateway gateway(*config, 1);
  gateway.start();
  Stage& stage = *gateway.find_stage("table");
  EXPECT_EQ(stage.whole(), use::Scope(stage::AxisSet::first(2)));
  const TimePoint limit = monotonic_now() + std::chrono::seconds(10);
  const auto link = [&] { return stage.newest_state().get().value->link; };
  while (link() != stage::LinkState::up && monotonic_now() < limit) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(link(), stage::LinkState::up);
}

TEST(GatewayWithShot2, AThirdAxisIsAnErrorOfTheConfiguration) {
  const auto config = parse("[[device.axis]]\nnumber = 3\n");
  ASSERT_FALSE(config);
  EXPECT_THAT(to_string(config.error().front()), HasSubstr("1 to 2"));
}

}  // namespace
}  // namespace axisgate::server
