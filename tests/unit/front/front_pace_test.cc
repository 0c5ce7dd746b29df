// Unfinished frames and calls: slow progress is allowed, endless waiting is not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "tests/unit/front/front_bed.h"

namespace axisgate::front::pace_test {
namespace {

using namespace std::string_literals;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::IsEmpty;
using testing::SizeIs;

class FrontPaceTest : public ConversationTest {
 protected:
  // Sends the bytes one by one, `each` apart; the front checks its time limits every 250 ms.
  void trickle(const std::string& bytes, milliseconds each) {
    for (std::size_t at = 0; at < bytes.size() && !conversation->over(); ++at) {
      say(bytes.substr(at, 1));
      pass(each);
    }
  }
  void pass(milliseconds span) {
    for (milliseconds passed{}; passed < span; passed += milliseconds(250)) {
      now += std::min(span - passed, milliseconds(250));
      conversation->check(now, true);
    }
  }
};

TEST_F(FrontPaceTest, AByteASecondEndsAfterTenSeconds) {
  open();
  const TimePoint begun = now;
  trickle(call(1, "/stop"), milliseconds(1000));
  EXPECT_EQ(fault(), "a frame was not finished in time");
  EXPECT_LE(now - begun, seconds(11));
  EXPECT_EQ(conversation->fault()->cause, Cause::frame_unfinished);
}

// The limit counts from the first byte of the frame, however old the connection is.
TEST_F(FrontPaceTest, ATimeBeginsWithWhatIsBegun) {
  now += seconds(1'000);
  open();
  pass(seconds(100));
  const std::string bytes = call(1, "/stop");
  say(bytes.substr(0, bytes.size() / 2));
  pass(seconds(9));
  EXPECT_EQ(fault(), "");
  say(bytes.substr(bytes.size() / 2) + message(1, "halt"));
  EXPECT_THAT(filter.asked, SizeIs(1));
}

// The library reports no headers for a call that has ended.
TEST_F(FrontPaceTest, IgnoredHeadersAreNotAwaited) {
  open();
  say(call(1, "/refused", true));
  heard();
  say(frame(FrameType::headers, kEndHeaders | kEndStream, 1, encoder.encode({{"x", "y"}})));
  pass(seconds(60));
  EXPECT_EQ(fault(), "");
}

TEST_F(FrontPaceTest, ASlowUploadThatGoesOnSucceeds) {
  open();
  say(call(1, "/forward"));
  std::string body = with_prefix(std::string(20'000, 'x'));
  for (std::size_t at = 0; at < body.size(); at += 500) {
    const bool last = at + 500 >= body.size();
    const std::string frames = frame(FrameType::data, last ? kEndStream : 0, 1, body.substr(at, 500));
    say(frames.substr(0, frames.size() / 2));  // reads do not end at frame boundaries
    pass(seconds(3));
    say(frames.substr(frames.size() / 2));
    passed_on();
    heard();
  }
  EXPECT_EQ(fault(), "");
  EXPECT_EQ(conversation->calls(), 1u);
}

TEST_F(FrontPaceTest, AMessageThatStallsIsRefusedByItself) {
  open();
  say(call(1, "/forward") + frame(FrameType::data, 0, 1, "\0\0\0\1\0abc"s));
  say(call(3, "/stop"));
  passed_on();
  pass(seconds(9));
  EXPECT_THAT(only(FrameType::headers, heard()), IsEmpty());
  pass(seconds(2));
  const std::vector<Seen> seen = only(FrameType::headers, heard());
  ASSERT_THAT(seen, SizeIs(2));
  EXPECT_EQ(find(headers_of(seen[0]), "grpc-status"), "4");
  EXPECT_EQ(fault(), "");
}

TEST_F(FrontPaceTest, AnIdleStreamIsNotConcerned) {
  open();
  say(call(1, "/forward") + message(1, "watch", false));
  say(call(3, "/forward"));
  passed_on();
  pass(seconds(600));
  EXPECT_THAT(only(FrameType::headers, heard()), IsEmpty());
  EXPECT_EQ(conversation->calls(), 2u);
}

// gRPC does not accept the data, so the client cannot continue.
TEST_F(FrontPaceTest, WhomGrpcHoldsBackIsNotSlow) {
  open();
  say(call(1, "/forward") + frame(FrameType::data, 0, 1, "\0\0\x10\0\0"s));
  passed_on();
  for (int i = 0; i < 8; ++i) {
    say(frame(FrameType::data, 0, 1, std::string(8'190, 'x')));
    passed_on();
  }
  say(frame(FrameType::data, 0, 1, std::string(11, 'x')));  // one byte more than gRPC's window
  passed_on();
  pass(seconds(60));
  EXPECT_THAT(only(FrameType::headers, heard()), IsEmpty());
  EXPECT_EQ(conversation->calls(), 1u);
}

TEST_F(FrontPaceTest, WhoIsNotReadIsNotSlow) {
  open();
  say(call(1, "/stop").substr(0, 20));
  for (int i = 0; i < 100; ++i) {
    now += seconds(1);
    conversation->check(now, false);
  }
  EXPECT_EQ(fault(), "");
}

}  // namespace
}  // namespace axisgate::front::pace_test
