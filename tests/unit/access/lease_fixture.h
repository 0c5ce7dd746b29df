// Fixture for the tests of leases and latches: the leases of one device, and their answers.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "device/stage/motion.h"
#include "server/access/leases.h"

namespace axisgate::server {

using stage::AxisSet;
using stage::MotionId;
using use::Scope;

inline constexpr Scope kOne = AxisSet::of(1), kTwo = AxisSet::of(2), kBoth = kOne | kTwo;
inline constexpr Reason kAllowed = Reason::unspecified;

class LeaseFixture : public testing::Test {
 protected:
  Result<Lease> acquire(const std::string& holder, Scope scope, AtLoss at_loss = AtLoss::stop) {
    Result<Lease> got = fail(Reason::internal, "not answered");
    leases_.acquire({.scope = scope, .at_loss = at_loss}, holder, false, now_, now_,
                    [&](const Result<Lease>& lease) { got = lease; });
    return got;
  }
  LeaseToken held_by(const std::string& holder, Scope scope, AtLoss at_loss = AtLoss::stop) {
    const auto lease = acquire(holder, scope, at_loss);
    EXPECT_TRUE(lease) << lease.error().message;
    return lease ? lease->token : 0;
  }
  // Waits for a lease for at most a minute; the answer is added to answers_.
  std::uint64_t wait_for(const std::string& holder, Scope scope, std::optional<Duration> use = {}) {
    return leases_.acquire(
        {.scope = scope, .expected_use = use}, holder, true, now_ + std::chrono::seconds(60), now_,
        [this, holder](const Result<Lease>& lease) {
          answers_.push_back(holder + (lease ? " has it" : " " + std::string(name(lease.error().reason))));
          if (lease) granted_ = lease->token;
        });
  }
  Reason may(const std::string& who, LeaseToken lease, Scope scope, MotionId motion = 0) {
    const auto allowed = leases_.authorize({who, lease, scope, motion}, now_);
    if (!allowed) told_ = allowed.error().message;
    return allowed ? Reason::unspecified : allowed.error().reason;
  }
  void begin(MotionId motion, const std::string& who, LeaseToken lease, Scope scope) {
    stage::Motion what;
    what.id = motion;
    what.axes = AxisSet::in(scope);
    what.who = who;
    leases_.begin({who, lease, scope, motion}, occupation_by(what), now_);
  }
  void pass(Duration time) {
    now_ += time;
    for (const auto& order : leases_.advance(now_).stops) orders_.push_back(order);
  }
  Scope rearm(const std::string& who, LeaseToken lease = 0) {
    Scope scope;
    for (const Latch& latch : leases_.rearm(lease, who, now_)) scope = scope | latch.scope;
    return scope;
  }
  void stop_by(const std::string& who, Scope scope, LeaseToken lease = 0, const std::vector<use::Use>& waiting = {}) {
    leases_.stop_asked({who, lease, scope, 0}, waiting, now_);
  }

  TimePoint now_{std::chrono::seconds(1000)};
  LeaseTokens tokens_{7};
  Leases leases_{tokens_};
  std::vector<std::string> answers_;
  std::vector<use::StopOrder> orders_;
  LeaseToken granted_ = 0;
  std::string told_;
};

}  // namespace axisgate::server
