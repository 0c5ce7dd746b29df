// Tests of leases: the terms that a caller may request, and callers that disconnect.
#include <gtest/gtest.h>

#include <atomic>

#include "tests/api/world.h"

namespace axisgate::api {
namespace {

using std::chrono::hours;
using std::chrono::milliseconds;
using std::chrono::seconds;

// A WaitingSeeker is a caller that waits for a lease, and may disconnect.
class WaitingSeeker final : public LeaseSeeker {
 public:
  bool answer(Result<std::optional<server::Lease>> lease) override {
    const std::lock_guard lock(mutex_);
    lease_ = std::move(lease);
    return !gone_;
  }
  void when_gone(std::function<void()> leave) override {
    const std::lock_guard lock(mutex_);
    leave_ = std::move(leave);
    waits_ = true;
  }
  void go() {
    std::function<void()> leave;
    {
      const std::lock_guard lock(mutex_);
      gone_ = true;
      leave = leave_;
    }
    if (leave) leave();
  }
  bool waits() {
    const std::lock_guard lock(mutex_);
    return waits_;
  }
  std::optional<Result<std::optional<server::Lease>>> lease() {
    const std::lock_guard lock(mutex_);
    return lease_;
  }

 private:
  std::mutex mutex_;
  bool gone_ = false, waits_ = false;
  std::function<void()> leave_;
  std::optional<Result<std::optional<server::Lease>>> lease_;
};

class LeasesOfApi : public ::testing::Test {
 protected:
  // Returns the message of the refusal; empty if the lease would be granted.
  std::string refusal(const Result<LeaseWish>& wish, Duration wait = {}) {
    const auto seeker = std::make_shared<WaitingSeeker>();
    Call call = World::by(kAnna);
    call.validate_only = true;
    world_.api->leases.acquire(call, kDevice, wish, wait, seeker);
    EXPECT_TRUE(comes_true([&] { return seeker->lease().has_value(); }));
    const auto lease = seeker->lease();
    return *lease ? "" : lease->error().message;
  }
  std::size_t held() {
    std::size_t count = 0;
    world_.on_strand([&](stage::StageController&, TimePoint) { count = world_.device().leases().held().size(); });
    return count;
  }
  std::size_t waiting() {
    std::size_t count = 0;
    world_.on_strand(
        [&](stage::StageController&, TimePoint now) { count = world_.device().leases().waiting(now).size(); });
    return count;
  }
  std::shared_ptr<WaitingSeeker> wait_for_lease() {
    const auto seeker = std::make_shared<WaitingSeeker>();
    world_.api->leases.acquire(World::by(kAnna), kDevice, LeaseWish(), seconds(20), seeker);
    EXPECT_TRUE(comes_true([&] { return seeker->waits(); }));
    return seeker;
  }

  World world_;
};

TEST_F(LeasesOfApi, TermsHaveTheirLimits) {
  EXPECT_EQ(refusal(LeaseWish{.time_to_live = milliseconds(999)}), "terms.time_to_live is shorter than 1 s");
  EXPECT_EQ(refusal(LeaseWish{.time_to_live = hours(25)}), "terms.time_to_live is not between 0 and 86400 s");
  EXPECT_EQ(refusal(LeaseWish{.time_to_live = seconds(-1)}), "terms.time_to_live is not between 0 and 86400 s");
  EXPECT_EQ(refusal(LeaseWish{.expected_use = hours(24 * 366)}), "terms.expected_use is not between 0 and 31536000 s");
  EXPECT_EQ(refusal(LeaseWish{.purpose = "a\n"}), "terms.purpose is not at most 200 printable ASCII characters");
  EXPECT_EQ(refusal(LeaseWish{.purpose = std::string(201, 'x')}),
            "terms.purpose is not at most 200 printable ASCII characters");
  EXPECT_EQ(refusal(LeaseWish(), hours(25)), "wait is not between 0 and 86400 s");
  EXPECT_EQ(
      refusal(LeaseWish{.time_to_live = hours(24), .expected_use = hours(24 * 365), .purpose = "scan"}, hours(24)), "");
  EXPECT_EQ(held(), 0u);
}

TEST_F(LeasesOfApi, NoAxesAreAll) {
  const auto seeker = std::make_shared<WaitingSeeker>();
  world_.api->leases.acquire(World::by(kAnna), kDevice, LeaseWish(), {}, seeker);
  ASSERT_TRUE(comes_true([&] { return seeker->lease().has_value(); }));
  EXPECT_EQ((**seeker->lease())->terms.scope, stage::AxisSet::of(1));
  EXPECT_EQ((**seeker->lease())->holder, kAnna);
}

TEST_F(LeasesOfApi, WhileSomethingMovesTheRefusalNamesIt) {
  world_.on_strand([&](stage::StageController&, TimePoint now) {
    stage::Motion motion;
    motion.id = 7;
    motion.axes = stage::AxisSet::of(1);
    motion.who = "unix bert";
    world_.device().leases().begin({motion.who, 0, motion.axes, motion.id}, stage::occupation_by(motion), now);
  });
  const auto seeker = std::make_shared<WaitingSeeker>();
  world_.api->leases.acquire(World::by(kAnna), kDevice, LeaseWish(), {}, seeker);
  ASSERT_TRUE(comes_true([&] { return seeker->lease().has_value(); }));
  ASSERT_FALSE(*seeker->lease());
  EXPECT_EQ(seeker->lease()->error().reason, Reason::lease_held);
  EXPECT_EQ(seeker->lease()->error().message, "axis 1 is in motion 7 (move by unix bert)");
}

TEST_F(LeasesOfApi, AWaitingCallerWhoGoesLeavesItsPlace) {
  (void)world_.lease_of("unix eve");
  const auto seeker = wait_for_lease();
  EXPECT_EQ(waiting(), 1u);
  seeker->go();
  EXPECT_EQ(waiting(), 0u);
}

// The lease is granted at the moment at which its caller disconnects.
TEST_F(LeasesOfApi, ALeaseWhoseCallerHasGoneIsGivenBack) {
  const auto seeker = std::make_shared<WaitingSeeker>();
  seeker->go();
  world_.api->leases.acquire(World::by(kAnna), kDevice, LeaseWish(), {}, seeker);
  EXPECT_TRUE(comes_true([&] { return seeker->lease().has_value() && held() == 0; }));
}

TEST_F(LeasesOfApi, AHandOverGoesToTheOneWhoWaits) {
  Call eve = World::by("unix eve");
  eve.lease_token = world_.sealed(world_.lease_of("unix eve"));
  const auto seeker = wait_for_lease();
  Asking<void> done;
  world_.api->leases.hand_over(eve, kDevice, kAnna, done.answer());
  EXPECT_EQ(done.reason(), Reason::unspecified);
  EXPECT_TRUE(comes_true([&] { return seeker->lease().has_value(); }));
}

TEST_F(LeasesOfApi, AConnectionThatBreaksOffLosesWhatItKeptAlive) {
  World slow([](World& configured) { configured.device_text = "speed = 1\noptions = { speed = \"1000\" }\n"; });
  Call call = World::by(kAnna);
  call.lease_token = slow.sealed(slow.lease_of(kAnna));
  const auto keeping = *slow.api->leases.keep_alive(call);
  Reader<server::Lease> reader(keeping);
  keeping->keep(kDevice, call.lease_token);
  EXPECT_EQ(reader.next()->sealed_token, call.lease_token);
  ASSERT_TRUE(slow.move(call, 100'000));
  keeping->break_off();
  EXPECT_TRUE(slow.all_ended());
  EXPECT_EQ(slow.motions().back().state, stage::MotionState::stopped);
}

TEST_F(LeasesOfApi, OneThatEndsInOrderLosesNothing) {
  const std::string token = world_.sealed(world_.lease_of(kAnna));
  const auto keeping = *world_.api->leases.keep_alive(World::by(kAnna));
  Reader<server::Lease> reader(keeping);
  keeping->keep(kDevice, token);
  ASSERT_TRUE(reader.next());
  keeping->finish();
  EXPECT_EQ(reader.reason(), Reason::unspecified);
  EXPECT_EQ(held(), 1u);
}

}  // namespace
}  // namespace axisgate::api
