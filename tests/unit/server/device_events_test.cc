#include "server/devices/device_events.h"

#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <vector>

#include "server/metrics/metrics.h"

namespace axisgate::server::device_events_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class DeviceEventsTest : public ::testing::Test {
 protected:
  void tell(const stage::Event& event) { events_.on_event(event, now_); }

  static stage::MotionChanged motion(stage::MotionId id, stage::MotionState state) {
    stage::Motion changed;
    changed.id = id;
    changed.state = state;
    return {changed};
  }

  const TimePoint now_{std::chrono::seconds(1000)};
  EventBus bus_{[](std::function<void()>) {}};
  Metrics metrics_;
  StageMetrics stage_metrics_{*metrics_.registry(), "stage", 3};
  DeviceRecorder recorder_{{}, [](std::function<void()>) {}, metrics_.recorder_drops("stage")};
  Newest<stage::State> state_{[](std::function<void()>) {}};
  std::vector<DeviceEvents::Due> due_;
  DeviceEvents events_{
      "stage", bus_, stage_metrics_, recorder_, state_, [this](DeviceEvents::Due due) { due_.push_back(due); }, {}};
};

TEST_F(DeviceEventsTest, FactsGetRevisionsAndTelemetryDoesNot) {
  tell(motion(1, stage::MotionState::queued));
  tell(stage::CompletionSeen{1, 1});
  tell(stage::PathProgress{1, stage::PathProgress::Step::sent, 1, "OK"});
  tell(stage::StopRequested{stage::AxisSet::first(3), false, "unix"});
  EXPECT_EQ(bus_.newest_revision(), 4u);
  tell(stage::ExchangeEnded{});
  tell(stage::BarrierEntered{"no reply"});
  tell(stage::UnexpectedLine{"?"});
  tell(stage::StateChanged{});
  EXPECT_EQ(bus_.newest_revision(), 4u);
  EXPECT_THAT(due_, ElementsAre(DeviceEvents::Due::queues, DeviceEvents::Due::state));
}

// A caller who was informed that a stop was obeyed or a latch lifted must not read an older state afterwards.
TEST_F(DeviceEventsTest, TheEndOfAStopAndALatchAreShownAtOnce) {
  stage::Stop stop{.id = 1, .axes = stage::AxisSet::first(3), .state = stage::StopState::written, .late = true};
  tell(stage::StopChanged{stop});
  EXPECT_THAT(due_, IsEmpty());
  stop.state = stage::StopState::confirmed;
  tell(stage::StopChanged{stop});
  tell(stage::EmergencyLatchChanged{});
  EXPECT_THAT(due_, ElementsAre(DeviceEvents::Due::state_at_once, DeviceEvents::Due::state_at_once));
}

// The calls come from a loop of stops over new connections, none of which has a name.
TEST_F(DeviceEventsTest, AFloodOfStopsIsToldOnce) {
  stage::Stop stop{.id = 1, .axes = stage::AxisSet::first(3)};
  for (int port = 40000; port < 40020; ++port) {
    const std::string who = "tcp 127.0.0.1:" + std::to_string(port);
    tell(stage::StopRequested{stop.axes, false, who});
    stop.callers.push_back(who);
  }
  EXPECT_EQ(bus_.newest_revision(), 1u) << "the first";
  stop.state = stage::StopState::confirmed;
  tell(stage::StopChanged{stop});
  EXPECT_EQ(bus_.newest_revision(), 1u);
}

TEST_F(DeviceEventsTest, AStopIsLateOnceHoweverManyJoinIt) {
  stage::Stop stop{.id = 1, .axes = stage::AxisSet::first(3), .state = stage::StopState::written, .late = true};
  for (const char* who : {"unix anna", "unix bert", "unix carl"}) {
    stop.callers.push_back(who);
    tell(stage::StopChanged{stop});
  }
  EXPECT_EQ(bus_.newest_revision(), 1u);
  stop.state = stage::StopState::confirmed;
  tell(stage::StopChanged{stop});
  EXPECT_EQ(bus_.newest_revision(), 2u);
}

// A setting is a transaction of lines; the log must not say "execute of no axis".
TEST_F(DeviceEventsTest, AMotionWithoutAxesNamesNone) {
  std::ostringstream text;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text)));
  stage::MotionChanged change = motion(7, stage::MotionState::running);
  change.motion.kind = stage::MotionKind::execute;
  change.motion.who = "unix anna";
  tell(change);
  change.motion.axes = stage::AxisSet::of(1);
  tell(change);
  spdlog::set_default_logger(before);
  EXPECT_THAT(text.str(), ::testing::HasSubstr("stage: motion 7 (execute, asked by unix anna) is RUNNING"));
  EXPECT_THAT(text.str(), ::testing::HasSubstr("stage: motion 7 (execute of axis 1, asked by unix anna) is RUNNING"));
}

TEST_F(DeviceEventsTest, TheStateIsFollowedWhileSomebodySubscribes) {
  EXPECT_FALSE(events_.state_followed());
  const auto reader = state_.subscribe([] {});
  EXPECT_TRUE(events_.state_followed());
}

TEST_F(DeviceEventsTest, AMotionsNewestRevisionIsKnown) {
  EXPECT_EQ(events_.motion_revision(1), 0u);
  tell(motion(1, stage::MotionState::queued));
  tell(motion(2, stage::MotionState::queued));
  tell(motion(1, stage::MotionState::running));
  EXPECT_EQ(events_.motion_revision(1), 3u);
  EXPECT_EQ(events_.motion_revision(2), 2u);
}

// A motion's times are the same however often and late they are read: its clock is fixed once.
TEST_F(DeviceEventsTest, TheTimesOfAMotionAreTheSameInAllItsFacts) {
  tell(motion(1, stage::MotionState::queued));
  const Moment clock = events_.motion_clock(1);
  EXPECT_EQ(clock.monotonic, now_);
  tell(motion(1, stage::MotionState::running));
  tell(motion(1, stage::MotionState::succeeded));
  EXPECT_EQ(events_.motion_clock(1).wall, clock.wall);
  const auto facts = bus_.read(1, 10).facts;
  ASSERT_EQ(facts.size(), 3u);
  for (const auto& fact : facts) {
    EXPECT_EQ(fact->clock.at(now_), clock.wall);
    EXPECT_EQ(fact->clock.at(now_ + std::chrono::nanoseconds(7)), clock.wall + std::chrono::nanoseconds(7));
  }
}

TEST_F(DeviceEventsTest, TheSameNewsOfTheLinkIsToldOnce) {
  const stage::LinkChanged down{stage::LinkState::down, "no such device"};
  tell(down);
  tell(down);
  EXPECT_EQ(bus_.newest_revision(), 1u);
  tell(stage::LinkChanged{stage::LinkState::down, "held by another process"});
  tell(stage::LinkChanged{stage::LinkState::up, ""});
  tell(down);
  EXPECT_EQ(bus_.newest_revision(), 4u);
  EXPECT_EQ(bus_.read(4, 1).facts.at(0)->device, "stage");
}

// Text from a device can neither clear the screen of a person who reads the log nor add a line to the log.
TEST_F(DeviceEventsTest, H42_ADevicesTextIsEscapedAndCappedInTheLog) {
  std::ostringstream log;
  const auto usual = spdlog::default_logger();
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>("", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
  tell(stage::UnexpectedLine{"\x1b[2J\r\n[info] all is well" + std::string(10'000, 'A')});
  spdlog::default_logger()->flush();
  spdlog::set_default_logger(usual);
  const std::string told = log.str();
  EXPECT_THAT(told, ::testing::HasSubstr("\\x1B[2J\\r\\n[info]"));
  EXPECT_EQ(told.find('\x1b'), std::string::npos);
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1);
  EXPECT_LT(told.size(), 300u);
}

}  // namespace
}  // namespace axisgate::server::device_events_test
