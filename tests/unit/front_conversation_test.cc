// What one client's bytes become.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/front_bed.h"

namespace axisgate::front::conversation_test {
namespace {

using namespace std::string_literals;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST_F(ConversationTest, NothingReachesGrpcBeforeItsFirstCall) {
  open();
  say(window_update(0, 1000) + frame(FrameType::ping, 0, 0, "12345678"));
  EXPECT_EQ(conversation->upstream(), Conversation::Upstream::none);
  EXPECT_FALSE(conversation->has_for_server());
  say(call(1, "/forward"));
  const std::vector<Seen> seen = passed_on();
  ASSERT_THAT(seen, SizeIs(3));
  EXPECT_EQ(seen[0].type, FrameType::settings);
  EXPECT_EQ(seen[1].type, FrameType::window_update);
  EXPECT_EQ(number_at(seen[1].payload, 0), 1000u);
  EXPECT_EQ(seen[2].type, FrameType::headers);
}

TEST_F(ConversationTest, TellsGrpcWhoCallsAndBelievesNoClientThere) {
  open();
  say(call(1, "/forward", false,
           {{"axisgate-caller", "unix root"}, {"axisgate-source", "uid 0"}, {"authorization", "Bearer x"}}));
  const Headers headers = headers_of(passed_on().back());
  EXPECT_EQ(find(headers, "axisgate-caller"), "unix anna");
  EXPECT_EQ(std::ranges::count(headers, "axisgate-caller", &Header::name), 1);
  EXPECT_EQ(find(headers, "axisgate-source"), "uid 1");
  EXPECT_EQ(std::ranges::count(headers, "axisgate-source", &Header::name), 1);
  EXPECT_EQ(find(headers, "authorization"), "Bearer x");
  EXPECT_EQ(headers.front().name, ":method");
}

TEST_F(ConversationTest, PassesDataAndResetsOfItsCallsOnly) {
  open();
  say(call(1, "/forward"));
  say(call(3, "/refused"));
  passed_on();
  say(message(1, "ab") + message(3, "cd") + rst_stream(3, ErrorCode::no_error) + window_update(3, 5) +
      window_update(1, 5) + rst_stream(1, ErrorCode::no_error));
  const std::vector<Seen> seen = passed_on();
  ASSERT_THAT(seen, SizeIs(3));
  for (const Seen& one : seen) EXPECT_EQ(one.stream, 1u);
}

TEST_F(ConversationTest, AnswersPingsByItself) {
  open();
  say(call(1, "/forward"));
  passed_on();
  say(frame(FrameType::ping, 0, 0, "12345678"));
  EXPECT_FALSE(conversation->has_for_server());
  const std::vector<Seen> answers = heard();
  ASSERT_THAT(answers, SizeIs(1));
  EXPECT_EQ(answers[0].flags, kAck);
  EXPECT_EQ(answers[0].payload, "12345678");
}

TEST_F(ConversationTest, ARefusalIsGrpcsAnswerAndEndsTheStream) {
  open();
  say(call(1, "/refused"));
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(2));
  EXPECT_EQ(seen[0].flags, kEndHeaders | kEndStream);
  const Headers headers = headers_of(seen[0]);
  EXPECT_EQ(find(headers, ":status"), "200");
  EXPECT_EQ(find(headers, "grpc-status"), "7");
  EXPECT_EQ(find(headers, "grpc-message"), "no: 100 %25");
  EXPECT_EQ(seen[1].type, FrameType::rst_stream);
  EXPECT_EQ(conversation->upstream(), Conversation::Upstream::none);
}

TEST_F(ConversationTest, AStopIsAnsweredWithoutGrpc) {
  open(true);
  say(call(1, "/stop") + message(1, "halt"));
  ASSERT_THAT(desk.asked, SizeIs(1));
  EXPECT_EQ(desk.asked[0].first, "halt");
  EXPECT_THAT(heard(), IsEmpty());
  desk.asked[0].second({.body = "stands"});
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(4));
  EXPECT_EQ(seen[0].type, FrameType::window_update);  // the bytes may be sent again
  EXPECT_EQ(number_at(seen[0].payload, 0), 9u);
  EXPECT_EQ(seen[2].payload, "\0\0\0\0\6stands"s);
  EXPECT_EQ(find(headers_of(seen[3]), "grpc-status"), "0");
  EXPECT_EQ(seen[3].flags, kEndHeaders | kEndStream);
  EXPECT_EQ(conversation->calls(), 0u);
}

TEST_F(ConversationTest, AStopInPiecesIsOneAndItsPaddingIsNone) {
  open();
  say(call(1, "/stop") + frame(FrameType::data, 0, 1, "\0\0\0"s));
  EXPECT_THAT(desk.asked, IsEmpty());
  say(frame(FrameType::data, 0x8 | kEndStream, 1, "\2\0\2ab\0\0"s));
  ASSERT_THAT(desk.asked, SizeIs(1));
  EXPECT_EQ(desk.asked[0].first, "ab");
}

TEST_F(ConversationTest, AStopThatItsCallerLeftIsNotAnswered) {
  open();
  say(call(1, "/stop") + message(1, "halt") + rst_stream(1, ErrorCode::no_error));
  heard();
  desk.asked[0].second({.body = "stands"});
  EXPECT_THAT(heard(), IsEmpty());
}

TEST_F(ConversationTest, AnAnswerWaitsForTheWindowAndGrpcLearnsNothingOfIt) {
  open();
  say(call(1, "/forward"));
  passed_on();
  // gRPC has used the whole window of the connection.
  std::string all;
  for (std::size_t left = 65'535; left > 0;) {
    const std::size_t size = std::min<std::size_t>(left, 16'384);
    all += frame(FrameType::data, 0, 1, std::string(size, 'x'));
    left -= size;
  }
  conversation->from_server(settings_ack() + all);
  heard();
  say(call(3, "/stop") + message(3, "halt"));
  heard();
  desk.asked[0].second({.body = "stands"});
  EXPECT_THAT(heard(), SizeIs(2));  // 9 bytes may be sent again; its head
  say(window_update(0, 100));
  EXPECT_THAT(heard(), SizeIs(2));
  const std::vector<Seen> seen = passed_on();
  ASSERT_THAT(seen, SizeIs(1));
  EXPECT_EQ(number_at(seen[0].payload, 0), 100u);
  say(window_update(0, 100));  // of these, 11 were the answer's
  EXPECT_EQ(number_at(passed_on()[0].payload, 0), 89u);
}

TEST_F(ConversationTest, AnAnswerIsNotBetweenHeadersAndTheirContinuation) {
  open();
  say(call(1, "/forward"));
  say(call(3, "/stop") + message(3, "halt"));
  heard();
  conversation->from_server(frame(FrameType::headers, 0, 1, "a"));
  desk.asked[0].second({.body = "stands"});
  say(frame(FrameType::ping, 0, 0, "12345678"));
  EXPECT_THAT(heard(), SizeIs(1));
  conversation->from_server(frame(FrameType::continuation, kEndHeaders, 1, "b"));
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(6));  // the PING's answer, 9 bytes that may be sent again, and the answer's three
  EXPECT_EQ(seen[0].type, FrameType::continuation);
}

TEST_F(ConversationTest, EachSideGetsItsOwnAcknowledgements) {
  open();
  say(call(1, "/forward"));
  passed_on();
  conversation->from_server(settings_frame({{4, 70'000}, {5, 1 << 20}}) + settings_ack());
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(1));                     // gRPC's acknowledgement is the front's
  EXPECT_EQ(seen[0].payload, "\0\4\0\1\x11\x70"s);  // and longer frames are not requested
  say(settings_ack());
  ASSERT_THAT(passed_on(), SizeIs(1));
  say(settings_frame({{4, 1}, {5, 1 << 20}}));
  EXPECT_EQ(passed_on()[0].payload, "\0\4\0\0\0\1"s);
  conversation->from_server(settings_ack());
  EXPECT_THAT(heard(), SizeIs(1));
}

TEST_F(ConversationTest, ACallHoldsItsPlaceUntilEitherSideEndsIt) {
  open();
  const auto held = [&] { return desk.place.use_count() - 1; };
  for (const std::uint32_t stream : {1, 3, 5}) say(call(stream, "/forward"));
  EXPECT_EQ(held(), 3);
  say(rst_stream(1, ErrorCode::no_error));
  EXPECT_EQ(held(), 2);
  conversation->from_server(frame(FrameType::headers, kEndHeaders | kEndStream, 3, "x"));
  EXPECT_EQ(held(), 1);
  conversation->from_server(rst_stream(5, ErrorCode::no_error));
  EXPECT_EQ(held(), 0);
}

TEST_F(ConversationTest, WithoutAWayToGrpcOnlyStopsAreServed) {
  open();
  say(call(1, "/forward"));
  conversation->upstream_failed();
  EXPECT_FALSE(conversation->has_for_server());
  EXPECT_EQ(find(headers_of(heard()[0]), "grpc-message"), "no room");
  EXPECT_EQ(desk.place.use_count(), 1);
  say(call(3, "/forward"));
  EXPECT_EQ(find(headers_of(heard()[0]), "grpc-status"), "7");
  say(call(5, "/stop") + message(5, "halt"));
  EXPECT_THAT(desk.asked, SizeIs(1));
}

TEST_F(ConversationTest, WhatIsNotHttp2IsNot) {
  open();
  conversation.emplace(
      desk, kLimits, sources, Peer{}, false, [](std::uint32_t) {}, now);
  say("GET /metrics HTTP/1.1\r\n");
  EXPECT_EQ(fault(), "this is not HTTP/2");
}

TEST_F(ConversationTest, BrokenFramesEndTheConnection) {
  const std::vector<std::string> broken = {
      frame(FrameType::headers, kEndHeaders, 2, "\x82"),
      frame(FrameType::headers, kEndHeaders, 1, "\xff\xff\xff\xff\xff\xff"),
      frame(FrameType::continuation, kEndHeaders, 1, "a"),
      frame(FrameType::headers, 0, 1, "a") + frame(FrameType::ping, 0, 0, "12345678"),
      frame(FrameType::headers, kEndHeaders | 0x8, 1, "\x09"),
      frame(FrameType::ping, 0, 0, "1234567"),
      frame(FrameType::window_update, 0, 0, "\0\0\0\0"s),
      frame(FrameType::window_update, 0, 0, "\x7f\xff\xff\xff"s),
      frame(FrameType::settings, 0, 0, "12345"),
      frame(FrameType::push_promise, 0, 1, "12345"),
      "\xff\xff\xff\0\0\0\0\0\1"s,
  };
  for (const std::string& bytes : broken) {
    open();
    say(bytes);
    ASSERT_TRUE(conversation->fault()) << testing::PrintToString(bytes);
    EXPECT_EQ(conversation->fault()->why.cause, Cause::protocol_error);
    EXPECT_EQ(heard().back().type, FrameType::goaway);
  }
}

}  // namespace
}  // namespace axisgate::front::conversation_test
