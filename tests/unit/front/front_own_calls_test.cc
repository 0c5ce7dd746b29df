// Calls that the front answers itself: requests in pieces, and answers that are limited by the client's windows (RFC
// 9113, 5.2 and 6.9).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "tests/unit/front/front_bed.h"

namespace axisgate::front::own_calls_test {
namespace {

using namespace std::string_literals;
using testing::Each;
using testing::ElementsAre;
using testing::Field;
using testing::IsEmpty;
using testing::SizeIs;

std::string data_in(const std::vector<Seen>& seen) {
  return std::accumulate(seen.begin(), seen.end(), std::string(), [](std::string all, const Seen& one) {
    return one.type == FrameType::data ? all + one.payload : all;
  });
}

class OwnCallsTest : public ConversationTest {
 protected:
  // Sends a complete call to /ask.
  void ask(std::uint32_t stream) { say(call(stream, "/ask") + message(stream, "?")); }
  // Returns the frames that a client receives, without window updates.
  std::vector<Seen> heard() {
    std::vector<Seen> seen = ConversationTest::heard();
    std::erase_if(seen, [](const Seen& one) { return one.type == FrameType::window_update; });
    return seen;
  }
  void answer(std::size_t number, Reply reply) { filter.asked.at(number).second(std::move(reply)); }
};

TEST_F(OwnCallsTest, AnAnswerOfSeveralMessagesHasOneHeadAndOneEnd) {
  open();
  ask(1);
  answer(0, {.body = "a", .last = false});
  std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(2));
  EXPECT_EQ(seen[0].type, FrameType::headers);
  EXPECT_EQ(seen[0].flags, kEndHeaders);
  answer(0, {.body = "b", .last = false});
  EXPECT_EQ(data_in(heard()), "\0\0\0\0\1b"s);
  answer(0, {});
  seen = heard();
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(seen[0].flags, kEndHeaders | kEndStream);
  const Headers end = headers_of(seen[0]);
  EXPECT_EQ(find(end, "grpc-status"), "0");
  EXPECT_EQ(find(end, ":status"), std::nullopt);
  EXPECT_EQ(conversation->calls(), 0u);
}

TEST_F(OwnCallsTest, AnAnswerWithoutMessagesIsOneFrame) {
  open();
  ask(1);
  answer(0, {.code = 9, .message = "held"});
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(find(headers_of(seen[0]), ":status"), "200");
  EXPECT_EQ(find(headers_of(seen[0]), "grpc-status"), "9");
}

TEST_F(OwnCallsTest, ItsPlaceIsGivenBackAtItsEndOrWhenItsCallerLeaves) {
  open();
  ask(1);
  ask(3);
  EXPECT_EQ(filter.place.use_count(), 3);
  answer(0, {.body = "a"});
  EXPECT_THAT(heard(), SizeIs(3));
  EXPECT_EQ(filter.place.use_count(), 2);
  say(rst_stream(3, ErrorCode::no_error));
  EXPECT_EQ(filter.place.use_count(), 1);
  answer(1, {.body = "too late"});
  EXPECT_THAT(heard(), IsEmpty());
}

TEST_F(OwnCallsTest, TheWindowOfTheStreamHoldsMessagesBackAndNotTheHead) {
  open();
  say(settings_frame({{4, 3}}));
  heard();
  ask(1);
  answer(0, {.body = "stands"});
  EXPECT_EQ(data_in(heard()), "\0\0\0"s);
  say(window_update(1, 7));
  EXPECT_EQ(data_in(heard()), "\0\6stand"s);
  EXPECT_EQ(conversation->calls(), 1u);
  say(window_update(1, 100));
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(2));
  EXPECT_EQ(seen[0].payload, "s");
  EXPECT_EQ(seen[1].flags, kEndHeaders | kEndStream);
}

// RFC 9113, 6.9.2: open windows change by the difference, and may become negative.
TEST_F(OwnCallsTest, ANewFirstWindowChangesThoseThatAreOpen) {
  open();
  say(settings_frame({{4, 4}}));
  ask(1);
  answer(0, {.body = "stands"});
  EXPECT_EQ(data_in(heard()), "\0\0\0\0"s);
  say(settings_frame({{4, 2}}));  // the window is now -2
  say(window_update(1, 3));
  EXPECT_EQ(data_in(heard()), "\6"s);
  say(settings_frame({{4, 100}}));
  say(window_update(1, 1));
  EXPECT_EQ(data_in(heard()), "stands");
}

TEST_F(OwnCallsTest, AWindowBeyondWhatThereCanBeEndsItsStreamOrTheConnection) {
  constexpr std::uint32_t kFlowControlError = 3;
  open();
  ask(1);
  say(window_update(1, 0x7fff'ffff));
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(seen[0].type, FrameType::rst_stream);
  EXPECT_EQ(number_at(seen[0].payload, 0), kFlowControlError);
  EXPECT_EQ(fault(), "");
  say(settings_frame({{4, 0x8000'0000}}));
  EXPECT_EQ(error_told(), kFlowControlError);
}

TEST_F(OwnCallsTest, LongMessagesAreCutIntoFrames) {
  open();
  ask(1);
  answer(0, {.body = std::string(40'000, 'x')});
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(5));
  EXPECT_THAT(data_in(seen), SizeIs(40'005));
  for (const Seen& one : seen) EXPECT_LE(one.payload.size(), 16'384u);
}

TEST_F(OwnCallsTest, ATooLongRequestIsRefusedAndTheConnectionGoesOn) {
  open();
  say(call(1, "/ask"));
  for (int i = 0; i < 5; ++i) say(frame(FrameType::data, 0, 1, std::string(16'000, 'x')));
  EXPECT_EQ(fault(), "");
  const std::vector<Seen> seen = heard();
  const auto ending = std::ranges::find(seen, FrameType::headers, &Seen::type);
  ASSERT_NE(ending, seen.end());
  EXPECT_EQ(find(headers_of(*ending), "grpc-status"), "8");
  EXPECT_THAT(filter.asked, IsEmpty());
  EXPECT_EQ(filter.place.use_count(), 1);
  ask(3);
  EXPECT_THAT(filter.asked, SizeIs(1));
}

// The filter refuses such a request, so the refusal is counted and logged like any other.
TEST_F(OwnCallsTest, ThatThereIsNotOneWholeMessageIsForTheDesk) {
  open();
  say(call(1, "/ask") + frame(FrameType::data, kEndStream, 1, "\0\0\0\0\2a"s));
  say(call(3, "/ask", true));
  ASSERT_THAT(filter.asked, SizeIs(2));
  EXPECT_EQ(filter.asked[0].first, std::nullopt);
  EXPECT_EQ(filter.asked[1].first, std::nullopt);
  EXPECT_EQ(fault(), "");
}

TEST_F(OwnCallsTest, LongRequestsThatAreNotWholeAreBoundedTogetherAndAStopFindsRoom) {
  open();
  Holding others(held);
  others.take(kLimits.held_bytes - 1);
  say(call(1, "/ask") + message(1, std::string(200, 'x')));
  EXPECT_THAT(filter.asked, SizeIs(1));
  say(call(3, "/ask") + frame(FrameType::data, 0, 3, "\0\0\0\x20\0"s + std::string(2'000, 'x')));
  EXPECT_EQ(find(headers_of(heard().at(0)), "grpc-status"), "8");
  EXPECT_EQ(held.held(), kLimits.held_bytes - 1);
  others.give_back();
  say(call(5, "/ask") + frame(FrameType::data, 0, 5, "\0\0\0\x20\0"s + std::string(2'000, 'x')));
  EXPECT_GT(held.held(), 900u);
  say(rst_stream(5, ErrorCode::no_error));
  EXPECT_EQ(held.held(), 0u);
}

TEST_F(OwnCallsTest, AClientThatReadsNothingIsNotWrittenForWithoutEnd) {
  open();
  say(settings_frame({{4, 0x7fff'ffff}}) + window_update(0, 0x7000'0000));
  heard();
  for (std::uint32_t number = 0; number < 20; ++number) {
    ask(2 * number + 1);
    answer(number, {.body = std::string(60'000, 'x'), .last = false});
  }
  std::size_t all = conversation->take_to_client().size();
  EXPECT_LT(all, 200'000u);
  for (int i = 0; i < 20; ++i) all += conversation->take_to_client().size();
  EXPECT_GT(all, 1'200'000u);
}

}  // namespace
}  // namespace axisgate::front::own_calls_test
