// Tests of the order of the checks, of validate_only and deadlines, and of stops, which bypass most checks.
#include <gtest/gtest.h>

#include <vector>

#include "server/api/request/names.h"
#include "tests/api/ask.h"

namespace axisgate::api {
namespace {

using std::chrono::milliseconds;

// Returns a move in an unknown unit, which the device would refuse.
Move move_in_no_unit() { return {{{.axis = 1, .distance = {{1, 0}, Unit::millimeters}}}, true}; }

Reason reason_of_asked(const World& world, const Call& call, const std::string& device, const Result<Move>& move) {
  Asking<StartedMotion> asking;
  world.api->motions.move(call, device, move, asking.answer());
  return asking.reason();
}

TEST(PipelineTest, OfSeveralFaultsTheFirstIsNamed) {
  World world;
  Call call = World::by(kAnna);
  const Result<Move> unreadable = fail(Reason::unknown_axis, "there is no axis 4");
  // Adds faults from the last that is checked to the first.
  EXPECT_EQ(reason_of_asked(world, call, kDevice, move_in_no_unit()), Reason::unknown_unit);
  EXPECT_EQ(reason_of_asked(world, call, kDevice, unreadable), Reason::unknown_axis);
  call.request_id = "\n";
  EXPECT_EQ(reason_of_asked(world, call, kDevice, unreadable), Reason::invalid_request);
  EXPECT_EQ(reason_of_asked(world, call, "devices/none", unreadable), Reason::unknown_device);
  EXPECT_EQ(reason_of_asked(world, call, "none", unreadable), Reason::invalid_request);
  call.credential.who = "unix olaf";
  EXPECT_EQ(reason_of_asked(world, call, "devices/none", unreadable), Reason::not_allowed);
  call.credential.token = "axisgate.none.none";
  EXPECT_EQ(reason_of_asked(world, call, "devices/none", unreadable), Reason::unauthenticated);
}

// An unknown name is refused before the right to its axes is checked.
TEST(PipelineTest, WhatThereIsGoesBeforeTheRightToIt) {
  World world;
  (void)world.lease_of("unix eve");
  EXPECT_EQ(ask(world, RequestKind::delete_position, World::by(kAnna)), Reason::not_found);
  save_position(world);
  EXPECT_EQ(ask(world, RequestKind::delete_position, World::by(kAnna)), Reason::lease_held);
  EXPECT_TRUE(world.positions->find("turn", "saved"));
}

TEST(PipelineTest, APassedEpochIsRefused) {
  World world;
  Call call = World::by(kAnna);
  call.device_epoch = world.state().device_epoch + 1;
  EXPECT_EQ(world.reason_of_move(call), Reason::epoch_passed);
  save_position(world);
  EXPECT_EQ(ask(world, RequestKind::delete_position, call), Reason::epoch_passed);
  call.device_epoch = world.state().device_epoch;
  call.frame_epoch = world.state().frame_epoch;
  EXPECT_EQ(world.reason_of_move(call), Reason::unspecified);
}

// Otherwise the caller would wait until the connection breaks, and would not know that nothing was done.
TEST(PipelineTest, WhatComesAfterTheEndOfADeviceIsRefused) {
  World world;
  world.device().shutdown();
  EXPECT_EQ(reason_of_asked(world, World::by(kAdmin), kDevice, move_in_no_unit()), Reason::daemon_ending);
  for (const RequestKind kind : {RequestKind::acquire_lease, RequestKind::clear_errors}) {
    EXPECT_EQ(ask(world, kind, World::by(kAdmin)), Reason::daemon_ending) << static_cast<int>(kind);
  }
}

TEST(PipelineTest, ValidateOnlyPostsNothing) {
  World world;
  save_position(world);
  const std::uint64_t revision = world.gateway->events().newest_revision();
  Call call = World::by(kAdmin);
  call.validate_only = true;
  for (const RequestKind kind : {RequestKind::move, RequestKind::home, RequestKind::return_to_origin,
                                 RequestKind::acquire_lease, RequestKind::take_over_lease, RequestKind::create_token,
                                 RequestKind::delete_position, RequestKind::clear_errors}) {
    EXPECT_EQ(ask(world, kind, call), Reason::unspecified) << static_cast<int>(kind);
  }
  EXPECT_EQ(reason_of_asked(world, call, kDevice, move_in_no_unit()), Reason::unknown_unit);
  EXPECT_TRUE(world.motions().empty());
  EXPECT_EQ(world.gateway->events().newest_revision(), revision);
  EXPECT_TRUE(world.device().newest_leases().get().value->held.empty());
  EXPECT_TRUE(world.access->tokens().list().empty());
  EXPECT_TRUE(world.positions->find("turn", "saved"));
}

// Applies to every kind that starts a motion, even if its plan is faulty: a rotor does not support scans, paths and
// saved positions.
TEST(PipelineTest, WhileTheDeviceIsNotUpNothingThatMovesIsPlanned) {
  World world;
  save_position(world);
  std::vector<RequestKind> moving;
  for (std::size_t number = 0; number < kRequestKinds; ++number) {
    const auto kind = static_cast<RequestKind>(number);
    if (rule_of(kind).deadline == DeadlineRule::motion) moving.push_back(kind);
  }
  ASSERT_EQ(moving.size(), 9U);
  Asking<std::string> silent;  // prevents that the device comes up again
  world.api->simulators.operate(World::by(kAnna), kDevice, "fault silent", silent.answer());
  ASSERT_EQ(silent.reason(), Reason::unspecified);
  world.on_strand([](stage::StageController& controller, TimePoint now) { controller.link_down(now, "unplugged"); });
  for (const RequestKind kind : moving) {
    EXPECT_EQ(ask(world, kind, World::by(kAnna)), Reason::link_down) << name(kind);
  }
  EXPECT_EQ(reason_of_asked(world, World::by(kAnna), kDevice, move_in_no_unit()), Reason::link_down);
  EXPECT_TRUE(world.motions().empty());
}

TEST(PipelineTest, ARevokedTokenStartsNothingButStillStops) {
  World world;
  Call call{.credential = {.token = world.token("scan", server::Role::operator_)}};
  EXPECT_EQ(world.reason_of_move(call), Reason::unspecified);
  ASSERT_TRUE(world.access->tokens().revoke("scan", server::calendar_now()));
  EXPECT_EQ(world.reason_of_move(call), Reason::unauthenticated);
  EXPECT_EQ(ask(world, RequestKind::get_device, call), Reason::unauthenticated);
  EXPECT_EQ(ask(world, RequestKind::stop, call), Reason::unspecified);
  EXPECT_EQ(ask(world, RequestKind::emergency_stop, call), Reason::unspecified);
}

class SlowWorld : public ::testing::Test {
 protected:
  World world_{[](World& configured) { configured.device_text = "speed = 1\noptions = { speed = \"1000\" }\n"; }};
};

TEST_F(SlowWorld, ADeadlineThatPassesWhileAMotionWaits) {
  const StartedMotion first = world_.move(World::by(kAnna), 100'000);
  ASSERT_TRUE(first);
  Call call = World::by(kAnna);
  call.not_after = monotonic_now() + milliseconds(50);
  EXPECT_EQ(world_.reason_of_move(call), Reason::deadline_passed);
  EXPECT_EQ(ask(world_, RequestKind::stop, World::by(kAnna)), Reason::unspecified);
}

// The device's strand is busy until the deadline has passed.
TEST_F(SlowWorld, ADeadlineThatPassesBeforeTheDeviceIsReached) {
  world_.device().post([](stage::StageController&, TimePoint) { std::this_thread::sleep_for(milliseconds(60)); });
  Call call = World::by(kAnna);
  call.not_after = monotonic_now() + milliseconds(20);
  EXPECT_EQ(world_.reason_of_move(call), Reason::deadline_passed);
  EXPECT_TRUE(world_.motions().empty());
}

TEST_F(SlowWorld, AStopGoesBeforeAllThatWaits) {
  std::vector<Asking<StartedMotion>> waiting(20);
  for (auto& asking : waiting) {
    world_.api->motions.move(World::by(kAnna), kDevice, World::way_of(100'000), asking.answer());
  }
  Call stop = World::by("unix olaf");
  stop.not_after = monotonic_now() - milliseconds(1);
  stop.request_id = "\n";
  (void)world_.lease_of("unix eve");
  EXPECT_EQ(ask(world_, RequestKind::stop, stop), Reason::unspecified);
  EXPECT_TRUE(world_.all_ended());
  for (const stage::Motion& motion : world_.motions()) EXPECT_EQ(motion.state, stage::MotionState::stopped);
}

TEST_F(SlowWorld, AStopNamesItsAxesAndItsDevice) {
  Asking<std::vector<DeviceStop>> unknown, unreadable;
  world_.api->stops.stop(World::by(kAnna), "devices/none", stage::AxisSet(), unknown.answer());
  EXPECT_EQ(unknown.reason(), Reason::unknown_device);
  world_.api->stops.stop(World::by(kAnna), kDevice, fail(Reason::unknown_axis, "there is no axis 4"),
                         unreadable.answer());
  EXPECT_EQ(unreadable.reason(), Reason::unknown_axis);
  Asking<std::vector<DeviceStop>> emergency;
  world_.api->stops.emergency_stop(World::by(kAnna), "devices/none", emergency.answer());
  EXPECT_EQ(emergency.reason(), Reason::unknown_device);
}

// Anna's own stop leaves no latch; a stop by another caller does, until Anna rearms.
TEST_F(SlowWorld, AnothersStopLatches) {
  ASSERT_TRUE(world_.move(World::by(kAnna), 100'000));
  EXPECT_EQ(ask(world_, RequestKind::stop, World::by(kAnna)), Reason::unspecified);
  ASSERT_TRUE(world_.move(World::by(kAnna), 100'000));
  EXPECT_EQ(ask(world_, RequestKind::stop, World::by("unix olaf")), Reason::unspecified);
  EXPECT_EQ(world_.reason_of_move(World::by(kAnna)), Reason::stopped_by);
  Asking<std::vector<server::Latch>> lifted;
  world_.api->leases.rearm(World::by(kAnna), kDevice, lifted.answer());
  const auto latches = lifted.get();
  ASSERT_EQ(latches.value_or(std::vector<server::Latch>()).size(), 1u);
  EXPECT_EQ(latches->front().scope, stage::AxisSet::of(1));
  EXPECT_EQ(latches->front().by, "unix olaf");
  EXPECT_EQ(world_.reason_of_move(World::by(kAnna)), Reason::unspecified);
}

TEST_F(SlowWorld, AMotionIsCancelledByItsName) {
  const StartedMotion motion = world_.move(World::by(kAnna), 100'000);
  ASSERT_TRUE(motion);
  Asking<void> cancelled;
  world_.api->motions.cancel(World::by("unix anders"), motion_name("turn", motion->motion.id), cancelled.answer());
  EXPECT_EQ(cancelled.reason(), Reason::unspecified);
  Asking<CurrentMotion> seen;
  EXPECT_TRUE(world_.all_ended());
  world_.api->motions.get(World::by(kAnna), motion_name("turn", motion->motion.id), seen.answer());
  EXPECT_EQ(seen.get()->motion.state, stage::MotionState::stopped);
}

}  // namespace
}  // namespace axisgate::api
