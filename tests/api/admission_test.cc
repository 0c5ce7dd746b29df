// Tests of the parts of a call's context that reach a device, and of its deadline.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/api/world.h"

namespace axisgate::api {
namespace {

using std::chrono::seconds;

class AdmissionTest : public ::testing::Test {
 protected:
  Result<use::RequestContext> context(RequestKind kind) const {
    return world_.api->admission.context_of(kind, call_, {kAnna, server::Role::operator_});
  }
  Duration validity(RequestKind kind) const { return context(kind)->not_after - monotonic_now(); }
  static void expect_about(Duration found, Duration expected) {
    EXPECT_LE(found, expected + std::chrono::milliseconds(100));
    EXPECT_GT(found, expected - seconds(1));
  }

  World world_;
  Call call_ = World::by(kAnna);
};

TEST_F(AdmissionTest, AMotionCountsFor5SecondsAndAnythingElseFor20) {
  expect_about(validity(RequestKind::move), seconds(5));
  expect_about(validity(RequestKind::change_settings), seconds(20));
  expect_about(validity(RequestKind::get_device), seconds(20));
  expect_about(validity(RequestKind::cancel_motion), seconds(20));
}

TEST_F(AdmissionTest, NotAfterSaysOtherwiseWhereSomethingIsChanged) {
  call_.not_after = monotonic_now() + seconds(60);
  expect_about(validity(RequestKind::move), seconds(60));
  expect_about(validity(RequestKind::change_settings), seconds(60));
  expect_about(validity(RequestKind::get_device), seconds(20));
  expect_about(validity(RequestKind::cancel_motion), seconds(20));
}

TEST_F(AdmissionTest, TheCallsDeadlineEndsItEarlier) {
  call_.deadline = monotonic_now() + seconds(3);
  call_.not_after = monotonic_now() + seconds(60);
  for (const RequestKind kind : {RequestKind::move, RequestKind::change_settings, RequestKind::get_device}) {
    expect_about(validity(kind), seconds(3));
  }
}

TEST_F(AdmissionTest, TheCallsDeadlineIsTheLimitOfAChangeButNotOfAMotion) {
  call_.deadline = monotonic_now() + seconds(100);
  expect_about(validity(RequestKind::move), seconds(5));
  expect_about(validity(RequestKind::change_settings), seconds(100));
  expect_about(validity(RequestKind::get_device), seconds(100));
}

TEST_F(AdmissionTest, LeaseAndEpochsReachWhatUsesAxes) {
  call_.lease_token = world_.sealed(5);
  call_.device_epoch = 6;
  call_.frame_epoch = 7;
  call_.request_id = "mine";
  const auto move = context(RequestKind::move);
  EXPECT_EQ(move->lease, 5u);
  EXPECT_EQ(move->device_epoch, 6u);
  EXPECT_EQ(move->frame_epoch, 7u);
  EXPECT_EQ(move->request_id, "mine");
  EXPECT_EQ(move->role, "operator");
  EXPECT_EQ(move->who, kAnna);
  EXPECT_EQ(context(RequestKind::rearm)->lease, 5u);
  EXPECT_EQ(context(RequestKind::rearm)->device_epoch, 0u);
  EXPECT_EQ(context(RequestKind::acquire_lease)->lease, 0u);
  EXPECT_EQ(context(RequestKind::get_device)->request_id, "");
}

TEST_F(AdmissionTest, CallersWhomNothingNamesTakeTurnsAsOne) {
  const auto turns_of = [this](const std::string& who) {
    const auto context = world_.api->admission.context_of(RequestKind::move, call_, {who, server::Role::operator_});
    EXPECT_EQ(context->who, who) << "for people";
    return context->takes_turns_as();
  };
  EXPECT_EQ(turns_of("tcp 127.0.0.1:39482"), turns_of("tcp 127.0.0.1:39483"));
  EXPECT_NE(turns_of("tcp 127.0.0.1:39482"), turns_of(kAnna));
  EXPECT_EQ(turns_of(kAnna), kAnna);
}

// A guessed token must not hinder a call that needs no lease, least of all a stop.
TEST_F(AdmissionTest, AGuessedLeaseTokenIsRefused) {
  call_.lease_token = world_.sealed(5);
  call_.lease_token.back() ^= 1;
  for (const RequestKind kind : {RequestKind::release_lease, RequestKind::rearm}) {
    ASSERT_FALSE(context(kind));
    EXPECT_EQ(context(kind).error().reason, Reason::lease_lost);
  }
  EXPECT_TRUE(context(RequestKind::acquire_lease));
  EXPECT_EQ(context(RequestKind::execute)->lease, server::LeaseTokens::kUnknown) << "its line may be a stop";
  EXPECT_EQ(context(RequestKind::move)->lease, server::LeaseTokens::kUnknown) << "it may be a repeat";
  EXPECT_EQ(world_.api->admission.context_of_stop(call_).lease, 0u);
}

TEST_F(AdmissionTest, ARequestIdIsShortAndPrintableUnlessItIsAStops) {
  for (const std::string& id : {std::string("a\nb"), std::string(129, 'x'), std::string("\x80")}) {
    call_.request_id = id;
    ASSERT_FALSE(context(RequestKind::move));
    EXPECT_EQ(context(RequestKind::move).error().reason, Reason::invalid_request);
    EXPECT_FALSE(context(RequestKind::acquire_lease));
    EXPECT_TRUE(context(RequestKind::get_device));
    EXPECT_TRUE(context(RequestKind::cancel_motion));
    const std::string kept = world_.api->admission.context_of_stop(call_).request_id;
    EXPECT_LE(kept.size(), 131u);
    EXPECT_TRUE(std::ranges::all_of(kept, [](char c) { return c >= ' ' && c <= '~'; })) << kept;
  }
  call_.request_id = std::string(128, '~');
  EXPECT_TRUE(context(RequestKind::move));
}

TEST_F(AdmissionTest, ATokenGoesBeforeTheConnection) {
  const std::string token = world_.token("scan", server::Role::observer);
  const Admission& admission = world_.api->admission;
  const auto by_token = admission.check_role(RequestKind::get_device, {.who = kAdmin, .token = token});
  ASSERT_TRUE(by_token);
  EXPECT_EQ(by_token->who, "token scan");
  EXPECT_EQ(by_token->role, server::Role::observer);
  EXPECT_FALSE(admission.check_role(RequestKind::move, {.who = kAdmin, .token = token}));
  EXPECT_FALSE(admission.check_role(RequestKind::get_device, {.who = kAdmin, .token = ""}));
  EXPECT_EQ(name_of({.who = kAdmin, .token = token}), "token scan");
}

// The refusal names the request as the door calls it, the required role and the caller's role.
TEST_F(AdmissionTest, ARefusalForPeople) {
  const auto refused = world_.api->admission.let_in(RequestKind::create_token, {.who = kAnna}, "/axisgate/CreateToken");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "/axisgate/CreateToken asks for the role admin, and unix anna is operator");
  const auto far = world_.api->admission.let_in(RequestKind::stop, {.who = "somebody", .needs_token = true}, "Stop");
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().message, "somebody needs a token here");
}

}  // namespace
}  // namespace axisgate::api
