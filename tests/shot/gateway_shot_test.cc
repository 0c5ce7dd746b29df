// The gateway with stages of one, two and eight axes: the configuration, and the scope of the whole device, know how
// many there are.
#include <fmt/format.h>
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

Configured<Config> parse(int axes, int axis) {
  const std::vector<const stage::Kind*> kinds = {&shot2::kind_of(axes)};
  return parse_config(fmt::format("[[device]]\nname = \"table\"\nkind = \"shot{}\"\nconnection = \"simulated\"\n"
                                  "[[device.axis]]\nnumber = {}\n",
                                  axes, axis),
                      "shot.toml", {.stages = kinds});
}

class GatewayWithShot : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Stages, GatewayWithShot, testing::Values(1, 2, 8));

TEST_P(GatewayWithShot, HasItsAxes) {
  const auto config = parse(GetParam(), GetParam());
  ASSERT_TRUE(config);
  Gateway gateway(*config, 1);
  gateway.start();
  Stage& stage = *gateway.find_stage("table");
  EXPECT_EQ(stage.whole(), use::Scope(stage::AxisSet::first(GetParam())));
  const TimePoint limit = monotonic_now() + std::chrono::seconds(10);
  const auto link = [&] { return stage.newest_state().get().value->link; };
  // Another thread publishes the state, in real time; the test looks until it has, or fails after ten seconds.
  while (link() != stage::LinkState::up && monotonic_now() < limit) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_EQ(link(), stage::LinkState::up);
}

TEST_P(GatewayWithShot, OneAxisMoreIsAnErrorOfTheConfiguration) {
  const auto config = parse(GetParam(), GetParam() + 1);
  ASSERT_FALSE(config);
  EXPECT_THAT(to_string(config.error().front()), HasSubstr("device.axis.number"));
}

}  // namespace
}  // namespace axisgate::server
