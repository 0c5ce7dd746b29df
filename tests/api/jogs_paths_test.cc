// Tests of jogs and paths: the effect of their messages, and their ends.
#include <gtest/gtest.h>

#include "tests/api/world.h"

namespace axisgate::api {
namespace {

using stage::MotionState;
using std::chrono::milliseconds;

class JogTest : public ::testing::Test {
 protected:
  static std::vector<JogAxis> plus() { return {{.axis = 1, .direction = 1}}; }
  bool start(const Result<std::vector<JogAxis>>& axes, const std::string& device = kDevice) {
    return jog_->start(World::by(kAnna), device, axes);
  }
  // Returns the next state. Expects that no earlier state follows a later one.
  std::optional<CurrentMotion> next() {
    auto one = reader_.next();
    EXPECT_GT(one ? one->revision : seen_ + 1, seen_);
    if (one) seen_ = one->revision;
    return one;
  }
  MotionState outcome() {
    std::optional<CurrentMotion> last;
    while (auto one = next()) last = one;
    return last ? last->motion.state : MotionState::queued;
  }
  Reason why() { return reader_.end().problem ? reader_.end().problem->reason : Reason::unspecified; }

  World world_;
  const std::shared_ptr<Jog> jog_ = *world_.api->jogs.open({.who = kAnna});
  Reader<CurrentMotion> reader_{jog_};
  std::uint64_t seen_ = 0;
};

// The jog is renewed for longer than the silence that ends a jog; the gateway runs in real time here.
TEST_F(JogTest, RunsUntilItsCallerEndsIt) {
  ASSERT_TRUE(start(plus()));
  EXPECT_EQ(next()->motion.state, MotionState::running);
  for (int i = 0; i < 4; ++i) {
    std::this_thread::sleep_for(milliseconds(200));
    EXPECT_TRUE(jog_->renew(std::vector<JogAxis>()));
  }
  jog_->finish();
  EXPECT_EQ(outcome(), MotionState::succeeded);
  EXPECT_EQ(why(), Reason::unspecified);
}

TEST_F(JogTest, WithoutMessagesItStops) {
  ASSERT_TRUE(start(plus()));
  EXPECT_EQ(outcome(), MotionState::stopped);
}

TEST_F(JogTest, ACallerThatBreaksOffStopsIt) {
  ASSERT_TRUE(start(plus()));
  ASSERT_TRUE(reader_.next());
  jog_->break_off();
  EXPECT_EQ(outcome(), MotionState::stopped);
}

// No jog may start for a caller that disconnected while the message was in transit.
TEST_F(JogTest, ACallerThatHasGoneStartsNothing) {
  world_.device().post([](stage::StageController&, TimePoint) { std::this_thread::sleep_for(milliseconds(50)); });
  ASSERT_TRUE(start(plus()));
  jog_->break_off();
  EXPECT_EQ(reader_.reason(), Reason::stopped);
  EXPECT_TRUE(world_.motions().empty());
}

TEST_F(JogTest, AMessageThatIsRefusedEndsIt) {
  ASSERT_TRUE(start(plus()));
  ASSERT_TRUE(reader_.next());
  EXPECT_FALSE(jog_->renew(fail(Reason::unknown_axis, "there is no axis 4")));
  EXPECT_EQ(reader_.reason(), Reason::unknown_axis);
  ASSERT_TRUE(world_.all_ended());
  EXPECT_EQ(world_.motions().back().state, MotionState::stopped);
}

TEST_F(JogTest, ASpeedOfAnAxisThatDoesNotJogEndsIt) {
  ASSERT_TRUE(start(plus()));
  ASSERT_TRUE(reader_.next());
  EXPECT_TRUE(jog_->renew(std::vector<JogAxis>{{.axis = 2, .speed = pulses(10)}}));
  EXPECT_EQ(reader_.reason(), Reason::unknown_axis);
  ASSERT_TRUE(world_.all_ended());
}

TEST_F(JogTest, TheFirstMessageNamesDeviceAndDirections) {
  EXPECT_FALSE(start(std::vector<JogAxis>{{.axis = 1}}));
  EXPECT_EQ(reader_.reason(), Reason::invalid_request);
  EXPECT_EQ(reader_.end().problem->message, "axis 1 has no direction to jog in");
}

TEST_F(JogTest, OnADeviceThatThereIs) {
  EXPECT_FALSE(start(plus(), "devices/none"));
  EXPECT_EQ(reader_.reason(), Reason::unknown_device);
}

TEST_F(JogTest, WithoutAMessageNothingIsMeant) {
  jog_->finish();
  EXPECT_EQ(reader_.reason(), Reason::invalid_request);
}

class PathTest : public ::testing::Test {
 protected:
  static stage::Segment segment() {
    stage::Segment one;
    one.moves = {{.axis = 1, .distance = pulses(10), .profile = {}}};
    return one;
  }
  bool start(Call call = World::by(kAnna), const std::string& device = kDevice) { return path_->start(call, device); }
  std::string refusal() {
    (void)reader_.reason();
    const auto& problem = reader_.end().problem;
    return problem ? std::string(name(problem->reason)) + ": " + problem->message : "";
  }

  World world_;
  const std::shared_ptr<Path> path_ = *world_.api->paths.open({.who = kAnna});
  Reader<PathStep> reader_{path_};
};

TEST_F(PathTest, OneHeadFirst) {
  EXPECT_FALSE(path_->add(segment()));
  EXPECT_EQ(refusal(), "INVALID_REQUEST: a segment came before the header");
}

TEST_F(PathTest, OnlyOneHead) {
  ASSERT_TRUE(start());
  EXPECT_FALSE(start());
  EXPECT_EQ(refusal(), "INVALID_REQUEST: a path has one header, and a second one came");
}

TEST_F(PathTest, AHeadIsAdmittedBeforeAnySegment) {
  EXPECT_FALSE(start(World::by("unix olaf")));
  EXPECT_EQ(reader_.reason(), Reason::not_allowed);
}

TEST_F(PathTest, SegmentsAreCounted) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(path_->add(segment()));
  stage::Segment late = segment();
  late.rest = milliseconds(255'001);
  EXPECT_FALSE(path_->add(late));
  EXPECT_EQ(refusal(), "OUT_OF_RANGE: segment 2: a rest of 255001 ms; 0 to 255000 ms are possible");
}

TEST_F(PathTest, InputsAreSix) {
  ASSERT_TRUE(start());
  stage::Segment waiting = segment();
  waiting.inputs = 64;
  EXPECT_FALSE(path_->add(waiting));
  EXPECT_EQ(refusal(), "OUT_OF_RANGE: segment 1: inputs that show 64; 0 to 63 are possible");
}

TEST_F(PathTest, CurvesThatAControllerHasNot) {
  const auto refused = [](std::variant<int, Decimal> extent, std::array<int, 2> axes, bool helix) {
    stage::Segment segment;
    segment.curve =
        stage::Curve{axes, stage::Curve::Around{{pulses(1), pulses(1)}, stage::Rotation::clockwise, extent}, {}};
    if (helix) segment.curve->rise = pulses(1);
    const Result<void> good = check_segment(segment);
    return good ? "" : std::string(name(good.error().reason)) + ": " + good.error().message;
  };
  EXPECT_EQ(refused(1, {1, 3}, false), "");
  EXPECT_EQ(refused(1000, {1, 2}, true), "");
  EXPECT_EQ(refused(Decimal{720, 0}, {1, 2}, true), "");
  EXPECT_EQ(refused(2, {1, 2}, false), "OUT_OF_RANGE: a circle of 2 turns; in one plane it has 1");
  EXPECT_EQ(refused(0, {1, 2}, true), "OUT_OF_RANGE: a helix of 0 turns; 1 to 1000 are possible");
  EXPECT_EQ(refused(1001, {1, 2}, true), "OUT_OF_RANGE: a helix of 1001 turns; 1 to 1000 are possible");
  EXPECT_EQ(refused(1, {1, 3}, true),
            "INVALID_REQUEST: the circle of a helix is one of axes 1 and 2, not of axes 1 and 3");
}

TEST_F(PathTest, AtMost100000Segments) {
  ASSERT_TRUE(start());
  for (std::size_t i = 0; i < stage::PathRequest::kSegmentsMax; ++i) ASSERT_TRUE(path_->add(segment()));
  EXPECT_FALSE(path_->add(segment()));
  EXPECT_EQ(refusal(), "INVALID_REQUEST: segment 100001 is one too many");
}

TEST_F(PathTest, WithoutASegmentThereIsNoPath) {
  ASSERT_TRUE(start());
  path_->run("");
  EXPECT_EQ(refusal(), "INVALID_REQUEST: the path has no segment");
}

TEST_F(PathTest, OfACallerThatBrokeOffNothingRuns) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(path_->add(segment()));
  path_->break_off();
  path_->run("");
  world_.on_strand([](stage::StageController&, TimePoint) {});
  EXPECT_FALSE(reader_.has_something());
}

// An operator's token is revoked while a stream and a jog use it.
TEST(RevokedToken, EndsItsStreamsAndItsJog) {
  World world;
  const Call call{.credential = {.token = world.token("scan", server::Role::operator_)}};
  const auto jog = *world.api->jogs.open(call.credential);
  Reader<CurrentMotion> jogging(jog);
  ASSERT_TRUE(jog->start(call, kDevice, std::vector<JogAxis>{{.axis = 1, .direction = 1}}));
  const auto running = jogging.next();
  ASSERT_TRUE(running);
  Reader<DeviceState> watching(*world.api->devices.watch(call, kDevice, {}));
  ASSERT_TRUE(world.api->tokens.revoke(World::by(kAdmin), "scan"));
  EXPECT_EQ(jogging.reason(), Reason::unauthenticated);
  EXPECT_EQ(watching.reason(), Reason::unauthenticated);
  EXPECT_EQ(watching.end().problem->message, "unix root revoked the token scan");
  EXPECT_TRUE(comes_true([&] {
    bool over = false;
    world.on_strand([&](const stage::StageController& controller, TimePoint) {
      over = controller.find_motion(running->motion.id)->state == MotionState::stopped;
    });
    return over;
  }));
}

// The caller loses the right to run the path while its segments are received.
TEST_F(PathTest, ATokenRevokedMeanwhile) {
  ASSERT_TRUE(start({.credential = {.token = world_.token("scan", server::Role::operator_)}}));
  ASSERT_TRUE(path_->add(segment()));
  ASSERT_TRUE(world_.access->tokens().revoke("scan", server::calendar_now()));
  path_->run("");
  EXPECT_EQ(reader_.reason(), Reason::unauthenticated);
}

TEST_F(PathTest, ReachesTheDevice) {
  ASSERT_TRUE(start());
  ASSERT_TRUE(path_->add(segment()));
  path_->run("");
  EXPECT_EQ(refusal(), "NOT_ALLOWED: device turn: a rotor has no look-ahead: paths are not possible");
}

}  // namespace
}  // namespace axisgate::api
