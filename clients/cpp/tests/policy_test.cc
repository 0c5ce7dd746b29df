// When a request is sent again, and how an outcome is awaited.
#include <gmock/gmock.h>
#include <google/protobuf/util/time_util.h>
#include <google/rpc/status.pb.h>

#include <vector>

#include "clients/cpp/src/following.h"
#include "clients/cpp/src/repeat.h"

namespace axisgate::client {
namespace {

using std::chrono::seconds;
using testing::ElementsAre;
using testing::SizeIs;

const Clock::time_point kStart{};
const Failure kBroken(grpc::Status(grpc::UNAVAILABLE, "Socket closed"));
const Failure kNever(grpc::Status(grpc::UNAVAILABLE, "failed to connect to all addresses; last error: refused"));

Failure refusal(v1::Reason reason, grpc::StatusCode code) {
  v1::Problem problem;
  problem.set_reason(reason);
  problem.set_message("a sentence.");
  google::rpc::Status details;
  details.add_details()->PackFrom(problem);
  return Failure(grpc::Status(code, "a sentence.", details.SerializeAsString()));
}

Repeat action(bool remembered = true) {
  return Repeat(
      {.until = kStart + seconds(5), .target = "here", .answer = seconds(3), .acts = true, .remembered = remembered});
}

// Returns the pauses in ms until the error, on a clock that only pauses move.
template <class Expected>
std::vector<std::int64_t> pauses(Repeat repeat, const Failure& failure) {
  std::vector<std::int64_t> all;
  Clock::time_point now = kStart;
  EXPECT_THROW(
      while (true) {
        const milliseconds pause = repeat.pause_after(failure, now);
        now += pause;
        all.push_back(pause.count());
      },
      Expected);
  return all;
}

TEST(Repeat, SendsARequestAgainWhoseAnswerWasLost) {
  EXPECT_THAT(pauses<OutcomeUnknown>(action(), kBroken), ElementsAre(250, 500, 1000, 2000, 1250));
}

TEST(Repeat, GivesEachAttemptTheTimeOfItsAnswer) {
  EXPECT_EQ(action().limit(kStart + seconds(1)), seconds(7));
  EXPECT_EQ(action().limit(kStart + seconds(9)), seconds(3));
}

TEST(Repeat, EndsUnavailableIfThereWasNeverAConnection) {
  EXPECT_THAT(pauses<Unavailable>(action(), kNever), SizeIs(5));
}

TEST(Repeat, EndsUnknownWithoutAConnectionAfterALostAnswer) {
  Repeat repeat = action();
  repeat.pause_after(kBroken, kStart);
  pauses<OutcomeUnknown>(repeat, kNever);
}

TEST(Repeat, EndsAtARefusal) {
  EXPECT_THROW(action().pause_after(refusal(v1::REASON_OUTSIDE_TRAVEL, grpc::OUT_OF_RANGE), kStart), OutsideTravel);
}

TEST(Repeat, SendsAgainWhileTheLineIsDown) {
  EXPECT_THAT(pauses<Unavailable>(action(), refusal(v1::REASON_LINK_DOWN, grpc::UNAVAILABLE)), SizeIs(5));
}

TEST(Repeat, BelievesARefusalAfterALostAnswerOnlyIfTheDaemonComparedTheId) {
  for (const v1::Reason reason : {v1::REASON_OUTSIDE_TRAVEL, v1::REASON_DEADLINE_PASSED}) {
    Repeat repeat = action();
    repeat.pause_after(kBroken, kStart);
    EXPECT_THROW(repeat.pause_after(refusal(reason, grpc::FAILED_PRECONDITION), kStart), Refused);
  }
  for (const v1::Reason reason : {v1::REASON_LEASE_LOST, v1::REASON_UNAUTHENTICATED, v1::REASON_REQUEST_MEMORY_LOST}) {
    Repeat repeat = action();
    repeat.pause_after(kBroken, kStart);
    EXPECT_THROW(repeat.pause_after(refusal(reason, grpc::FAILED_PRECONDITION), kStart), OutcomeUnknown);
  }
}

TEST(Repeat, SendsNothingAgainThatTheDaemonDoesNotRemember) {
  Repeat repeat = action(false);
  repeat.pause_after(kNever, kStart);
  EXPECT_THROW(repeat.pause_after(kBroken, kStart), OutcomeUnknown);
}

TEST(Failure, ShowsAReasonThatThisVersionDoesNotKnow) {
  EXPECT_EQ(refusal(static_cast<v1::Reason>(999), grpc::FAILED_PRECONDITION).reason(), "REASON 999");
}

TEST(Failure, TakesALongAnswerForALostOne) {
  EXPECT_TRUE(Failure(grpc::Status(grpc::RESOURCE_EXHAUSTED, "Received message larger than max")).lost());
}

v1::Motion motion(const std::string& request_id) {
  v1::Motion motion;
  motion.set_name("devices/stage/motions/1");
  motion.set_request_id(request_id);
  return motion;
}

TEST(Following, AsksForAtMostTenSeconds) {
  const Following following(motion("mine"), "here", kStart);
  const v1::WaitMotionRequest question = following.question(milliseconds::max());
  EXPECT_EQ(google::protobuf::util::TimeUtil::DurationToMilliseconds(question.max_wait()), 10'000);
  EXPECT_EQ(Following::limit(question), seconds(15));
}

TEST(Following, DoesNotTakeAnotherMotionForItsOwn) {
  Following following(motion("mine"), "here", kStart);
  EXPECT_THROW(following.take(motion("another"), kStart), OutcomeUnknown);
}

TEST(Following, EndsUnknownAfterAMinuteWithoutAnAnswer) {
  Following following(motion("mine"), "here", kStart);
  EXPECT_EQ(following.pause_after(kBroken, kStart + seconds(60)), milliseconds(250));
  EXPECT_THROW(following.pause_after(kBroken, kStart + seconds(61)), OutcomeUnknown);
}

TEST(Following, EndsUnknownIfTheDaemonNoLongerHasTheMotion) {
  Following following(motion("mine"), "here", kStart);
  EXPECT_THROW(following.pause_after(refusal(v1::REASON_NOT_FOUND, grpc::NOT_FOUND), kStart), OutcomeUnknown);
}

}  // namespace
}  // namespace axisgate::client
