// Tests of requests that are repeated with the same id: each acts once.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/api/ask.h"

namespace axisgate::api {
namespace {

Call call_with(std::string id, std::string digest = "by 10", const char* who = kAnna) {
  Call call = World::by(who);
  call.request_id = std::move(id);
  call.digest = std::move(digest);
  return call;
}

std::size_t motions_of(World& world) {
  Asking<std::vector<CurrentMotion>> asking;
  world.api->motions.list(World::by(kAnna), kDevice, asking.answer());
  return asking.get()->size();
}

TEST(RepeatsTest, H34_AMoveThatComesAgainIsTheSameMotion) {
  World world;
  const StartedMotion first = world.move(call_with("align-17"), 10);
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->is_repeated);
  const StartedMotion again = world.move(call_with("align-17"), 10);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->is_repeated);
  EXPECT_EQ(again->motion.id, first->motion.id);
  ASSERT_TRUE(world.all_ended());
  const StartedMotion ended = world.move(call_with("align-17"), 10);
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->motion.state, stage::MotionState::succeeded);
  EXPECT_EQ(ended->motion.who, kAnna);
  EXPECT_EQ(motions_of(world), 1u);
}

// Only one of twenty simultaneous requests acts; all receive the same motion.
TEST(RepeatsTest, ManyAtOnceAreOneMotion) {
  World world;
  std::vector<Asking<StartedMotion>> askings(20);
  for (auto& asking : askings) {
    world.api->motions.move(call_with("align-17"), kDevice, World::way_of(10), asking.answer());
  }
  int repeated = 0;
  for (auto& asking : askings) {
    const auto motion = asking.get();
    ASSERT_TRUE(motion);
    EXPECT_EQ((*motion)->motion.id, 1u);
    repeated += (*motion)->is_repeated ? 1 : 0;
  }
  EXPECT_EQ(repeated, 19);
  EXPECT_EQ(motions_of(world), 1u);
}

TEST(RepeatsTest, H34_WithAnotherContentItIsRefused) {
  World world;
  ASSERT_TRUE(world.move(call_with("align-17"), 10));
  EXPECT_EQ(world.reason_of_move(call_with("align-17", "by 20"), 20), Reason::request_id_reused);
  Asking<StartedMotion> home;
  world.api->motions.home(call_with("align-17"), kDevice, stage::AxisSet(), home.answer());
  EXPECT_EQ(home.reason(), Reason::request_id_reused) << "another kind of request is another request";
}

TEST(RepeatsTest, ARefusalLeavesTheIdFree) {
  World world;
  const server::LeaseToken lease = world.lease_of("unix eve");
  EXPECT_EQ(world.reason_of_move(call_with("align-17")), Reason::lease_held);
  world.on_strand(
      [&](stage::StageController&, TimePoint now) { (void)world.gateway->stages()[0]->leases().release(lease, now); });
  EXPECT_EQ(world.reason_of_move(call_with("align-17")), Reason::unspecified);
}

// A repeat receives the earlier result, even if epochs, leases or deadlines have changed since.
TEST(RepeatsTest, ARepeatIsAnsweredBeforeEpochsLeasesAndDeadlines) {
  World world;
  ASSERT_TRUE(world.move(call_with("align-17"), 10));
  Call late = call_with("align-17");
  late.device_epoch = world.state().device_epoch + 1;
  late.lease_token = "of another run of the daemon";
  late.not_after = TimePoint{};
  const StartedMotion again = world.move(late, 10);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->is_repeated);
}

TEST(RepeatsTest, AllNamelessCallersOfLoopbackAreOne) {
  World world;
  ASSERT_TRUE(world.move(call_with("align-17", "by 10", "tcp 127.0.0.1:1000"), 10));
  const StartedMotion again = world.move(call_with("align-17", "by 10", "tcp 127.0.0.1:2000"), 10);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->is_repeated);
  const StartedMotion annas = world.move(call_with("align-17"), 10);
  ASSERT_TRUE(annas);
  EXPECT_FALSE(annas->is_repeated) << "anna has ids of her own";
}

TEST(RepeatsTest, WithoutAnIdNothingIsRemembered) {
  World world;
  ASSERT_TRUE(world.move(call_with(""), 10));
  const StartedMotion second = world.move(call_with(""), 10);
  ASSERT_TRUE(second);
  EXPECT_FALSE(second->is_repeated);
  EXPECT_EQ(motions_of(world), 2u);
}

TEST(RepeatsTest, AChangeIsDoneOnce) {
  World world;
  save_position(world);
  const Call call = call_with("tidy-1", "saved");
  for (int i = 0; i < 2; ++i) {
    Asking<void> removal;
    world.api->positions.remove(call, kSaved, removal.answer());
    EXPECT_EQ(removal.reason(), Reason::unspecified) << i;
  }
  Asking<void> another;
  world.api->positions.remove(call_with("tidy-2", "saved"), kSaved, another.answer());
  EXPECT_EQ(another.reason(), Reason::not_found) << "it was removed";
}

TEST(RepeatsTest, AJogNeverStartsTwice) {
  World world;
  stage::MotionId first = 0;
  for (int i = 0; i < 2; ++i) {
    auto jog = *world.api->jogs.open(World::by(kAnna).credential);
    Reader<CurrentMotion> reader(jog);
    ASSERT_TRUE(jog->start(call_with("jog-1", "plus"), kDevice,
                           std::vector<JogAxis>{{.axis = 1, .direction = 1, .speed = pulses(100)}}));
    const auto motion = reader.next();
    ASSERT_TRUE(motion);
    if (i == 0) first = motion->motion.id;
    EXPECT_EQ(motion->motion.id, first);
    EXPECT_EQ(motion->is_repeated, i == 1);
    jog->finish();
    (void)reader.reason();
  }
  EXPECT_EQ(motions_of(world), 1u);
}

// The lease of the first request may have ended since, for instance with the daemon.
TEST(RepeatsTest, ARepeatUnderALeaseThatHasEndedReceivesTheFirstResult) {
  World world;
  Call call = call_with("leased-1");
  call.lease_token = world.sealed(world.lease_of(kAnna));
  EXPECT_EQ(world.reason_of_move(call), Reason::unspecified);
  call.lease_token.back() ^= 1;
  EXPECT_EQ(world.reason_of_move(call), Reason::unspecified);
  EXPECT_EQ(motions_of(world), 1u);
  call.request_id = "leased-2";
  EXPECT_EQ(world.reason_of_move(call), Reason::lease_lost);
}

// A repeated rearm does not end the latch of a stop that came after the first rearm.
TEST(RepeatsTest, ARearmIsDoneOnce) {
  World world;
  world.latch(kAnna);
  const auto rearm = [&] {
    Asking<std::vector<server::Latch>> asking;
    world.api->leases.rearm(call_with("rearm-1"), kDevice, asking.answer());
    return asking.get();
  };
  EXPECT_EQ(rearm()->size(), 1u);
  EXPECT_EQ(world.reason_of_move(call_with("")), Reason::unspecified);
  world.latch(kAnna);
  EXPECT_TRUE(rearm()->empty());
  EXPECT_EQ(world.reason_of_move(call_with("")), Reason::stopped_by);
}

// The first answer was lost, but the lease was released as requested.
TEST(RepeatsTest, AReleaseIsDoneOnce) {
  World world;
  Call call = call_with("release-1");
  call.lease_token = world.sealed(world.lease_of(kAnna));
  for (int i = 0; i < 2; ++i) {
    Asking<void> asking;
    world.api->leases.release(call, kDevice, asking.answer());
    EXPECT_EQ(asking.reason(), Reason::unspecified);
  }
  call.request_id = "release-2";
  Asking<void> asking;
  world.api->leases.release(call, kDevice, asking.answer());
  EXPECT_EQ(asking.reason(), Reason::lease_lost);
}

}  // namespace
}  // namespace axisgate::api
