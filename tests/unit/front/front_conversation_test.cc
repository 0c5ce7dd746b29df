// Handling of the bytes of one client.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "server/front/replies.h"
#include "tests/unit/front/front_bed.h"

namespace axisgate::front::conversation_test {
namespace {

using namespace std::string_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

constexpr std::uint32_t kProtocolError = 1, kRefusedStream = 7;

TEST_F(ConversationTest, NothingReachesGrpcBeforeItsFirstCall) {
  open();
  say(window_update(0, 1000) + frame(FrameType::ping, 0, 0, "12345678"));
  EXPECT_FALSE(conversation->uses_grpc());
  say(call(1, "/forward"));
  const std::vector<Seen> seen = passed_on();
  EXPECT_EQ(seen.front().type, FrameType::settings);
  EXPECT_EQ(seen.back().type, FrameType::headers);
}

TEST_F(ConversationTest, TellsGrpcWhoCallsAndBelievesNoClientThere) {
  open();
  say(call(1, "/forward", false,
           {{"axisgate-caller", "unix root"}, {"axisgate-source", "uid 0"}, {"authorization", "Bearer x"}}));
  const Headers headers = *grpc_decoder.decode(passed_on().back().payload, 1 << 16);
  EXPECT_EQ(find(headers, "axisgate-caller"), "unix anna");
  EXPECT_EQ(std::ranges::count(headers, "axisgate-caller", &Header::name), 1);
  EXPECT_EQ(find(headers, "axisgate-source"), "uid 1");
  EXPECT_EQ(std::ranges::count(headers, "axisgate-source", &Header::name), 1);
  EXPECT_EQ(find(headers, "authorization"), "Bearer x");
  EXPECT_EQ(find(headers, ":path"), "/forwarded");
  EXPECT_EQ(headers.front().name, ":method");
}

TEST_F(ConversationTest, PassesDataAndResetsOfItsCallsOnly) {
  open();
  say(call(1, "/forward"));
  say(call(3, "/refused"));
  passed_on();
  heard();
  say(message(1, "ab", false) + message(3, "cd"));
  say(rst_stream(1, ErrorCode::no_error));
  const std::vector<Seen> seen = passed_on();
  EXPECT_FALSE(seen.empty());
  for (const Seen& one : seen) EXPECT_TRUE(one.stream == 1 || one.type == FrameType::settings);
  EXPECT_EQ(seen.back().type, FrameType::rst_stream);
  EXPECT_EQ(fault(), "");
}

TEST_F(ConversationTest, ACallGoesToGrpcAndItsAnswerBack) {
  open();
  say(call(1, "/forward") + message(1, "ab"));
  EXPECT_EQ(only(FrameType::data, passed_on()).at(0).payload, "\0\0\0\0\2ab"s);
  grpc_says(answer(1, false) + message(1, "xyz", false));
  grpc_says(trailers(1));
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(3));
  EXPECT_EQ(seen[1].payload, "\0\0\0\0\3xyz"s);
  EXPECT_TRUE(seen[2].ends_stream());
  EXPECT_EQ(conversation->calls(), 0u);
}

TEST_F(ConversationTest, AnswersPingsByItself) {
  open();
  say(call(1, "/forward"));
  passed_on();
  passed_on();
  say(frame(FrameType::ping, 0, 0, "12345678"));
  EXPECT_THAT(passed_on(), IsEmpty());
  const std::vector<Seen> answers = only(FrameType::ping, heard());
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
  EXPECT_FALSE(conversation->uses_grpc());
}

TEST_F(ConversationTest, AStopIsAnsweredWithoutGrpc) {
  open(true);
  say(call(1, "/stop") + message(1, "halt"));
  ASSERT_THAT(filter.asked, SizeIs(1));
  EXPECT_EQ(filter.asked[0].first, "halt");
  EXPECT_THAT(heard(), IsEmpty());
  filter.asked[0].second({.body = "stands"});
  const std::vector<Seen> seen = heard();
  ASSERT_THAT(seen, SizeIs(3));
  headers_of(seen[0]);
  EXPECT_EQ(seen[1].payload, "\0\0\0\0\6stands"s);
  EXPECT_EQ(find(headers_of(seen[2]), "grpc-status"), "0");
  EXPECT_EQ(seen[2].flags, kEndHeaders | kEndStream);
  EXPECT_EQ(conversation->calls(), 0u);
}

TEST_F(ConversationTest, AStopInPiecesIsOneAndItsPaddingIsNone) {
  open();
  say(call(1, "/stop") + frame(FrameType::data, 0, 1, "\0\0\0"s));
  EXPECT_THAT(filter.asked, IsEmpty());
  say(frame(FrameType::data, 0x8 | kEndStream, 1, "\2\0\2ab\0\0"s));
  ASSERT_THAT(filter.asked, SizeIs(1));
  EXPECT_EQ(filter.asked[0].first, "ab");
}

// RFC 9113, 8.1: trailers may end a request; gRPC clients send none, but proxies may.
TEST_F(ConversationTest, TrailersEndARequest) {
  open();
  const auto trailers_of_request = [this](std::uint32_t stream) {
    return frame(FrameType::headers, kEndHeaders | kEndStream, stream, encoder.encode({{"x", "y"}}));
  };
  say(call(1, "/stop") + message(1, "halt", false));
  say(trailers_of_request(1));
  ASSERT_THAT(filter.asked, SizeIs(1));
  EXPECT_EQ(filter.asked[0].first, "halt");
  say(call(3, "/forward") + message(3, "ab", false));
  say(trailers_of_request(3));
  EXPECT_TRUE(only(FrameType::data, passed_on()).back().ends_stream());
}

TEST_F(ConversationTest, AStopThatItsCallerLeftIsNotAnswered) {
  open();
  say(call(1, "/stop") + message(1, "halt") + rst_stream(1, ErrorCode::no_error));
  heard();
  filter.asked[0].second({.body = "stands"});
  EXPECT_THAT(heard(), IsEmpty());
}

TEST_F(ConversationTest, ManyCallsAtOnceAreAllAnswered) {
  open();
  for (std::uint32_t stream = 1; stream < 1001; stream += 2) say(call(stream, "/ask") + message(stream, "x"));
  ASSERT_THAT(filter.asked, SizeIs(500));
  for (const auto& one : filter.asked) one.second({.body = "y"});
  EXPECT_THAT(only(FrameType::data, heard()), SizeIs(500));
  EXPECT_EQ(fault(), "");
}

TEST_F(ConversationTest, BeyondItsBoundAStopIsRefusedByItself) {
  open();
  std::uint32_t stream = 1;
  for (; stream < 2 * kLimits.answers; stream += 2) say(call(stream, "/stop") + message(stream, "x"));
  EXPECT_THAT(heard(), IsEmpty());
  say(call(stream, "/stop") + message(stream, "x"));
  const Headers headers = headers_of(heard().at(0));
  EXPECT_EQ(find(headers, "grpc-status"), "8");
  EXPECT_EQ(find(headers, "grpc-retry-pushback-ms"), "1000");
  filter.asked[0].second({.body = "stands"});
  EXPECT_THAT(heard(), SizeIs(3));
}

TEST_F(ConversationTest, WhatIsNoCallMaySendItsBody) {
  open();
  Headers json = headers_for("/stop");
  json.back().value = "application/json";
  say(frame(FrameType::headers, kEndHeaders, 1, encoder.encode(json)));
  heard();
  for (int i = 0; i < 60; ++i) say(frame(FrameType::data, 0, 1, std::string(1'000, 'x')));
  EXPECT_EQ(fault(), "");
}

TEST_F(ConversationTest, ACallHoldsItsPlaceUntilItEnds) {
  open();
  const auto held_places = [&] { return filter.place.use_count() - 1; };
  for (const std::uint32_t stream : {1, 3, 5}) say(call(stream, "/forward"));
  passed_on();
  EXPECT_EQ(held_places(), 3);
  say(rst_stream(1, ErrorCode::no_error));
  EXPECT_EQ(held_places(), 2);
  grpc_says(answer(3, true));
  heard();
  EXPECT_EQ(held_places(), 1);
  grpc_says(rst_stream(5, ErrorCode::no_error));
  heard();
  EXPECT_EQ(held_places(), 0);
}

TEST_F(ConversationTest, WithoutAWayToGrpcOnlyStopsAreServed) {
  open();
  say(call(1, "/forward"));
  conversation->grpc_failed();
  EXPECT_FALSE(conversation->has_for_grpc());
  EXPECT_EQ(find(headers_of(heard()[0]), "grpc-message"), "no room");
  EXPECT_EQ(filter.place.use_count(), 1);
  say(call(3, "/forward"));
  EXPECT_EQ(find(headers_of(heard()[0]), "grpc-status"), "7");
  say(call(5, "/stop") + message(5, "halt"));
  EXPECT_THAT(filter.asked, SizeIs(1));
}

// gRPC ends in two steps, and so does the front; the last stream in its GOAWAY covers the front's own calls too.
TEST_F(ConversationTest, GrpcsFarewellIsTheFronts) {
  open();
  say(call(1, "/forward"));
  say(call(3, "/stop") + message(3, "halt"));
  passed_on();
  grpc_says(goaway(0x7fff'ffff, ErrorCode::no_error, ""));
  EXPECT_EQ(number_at(only(FrameType::goaway, heard()).at(0).payload, 0), 0x7fff'ffffu);
  grpc_says(goaway(1, ErrorCode::no_error, ""));
  EXPECT_EQ(number_at(only(FrameType::goaway, heard()).at(0).payload, 0), 3u);
  filter.asked[0].second({.body = "stands"});
  EXPECT_THAT(only(FrameType::data, heard()), SizeIs(1));
  conversation->grpc_left();
  heard();
  EXPECT_TRUE(conversation->over());
  EXPECT_FALSE(conversation->fault());
}

TEST_F(ConversationTest, AnEndIsAnnouncedAndCallsThatStillComeMayBeMadeElsewhere) {
  open();
  say(call(1, "/forward"));
  passed_on();
  heard();
  conversation->announce_end();
  const std::vector<Seen> farewell = heard();
  ASSERT_THAT(farewell, SizeIs(1));
  EXPECT_EQ(farewell[0].type, FrameType::goaway);
  EXPECT_EQ(farewell[0].payload, "\x7f\xff\xff\xff\0\0\0\0"s) << "no error, and any last stream";
  say(call(3, "/forward"));
  EXPECT_THAT(only(FrameType::headers, passed_on()), IsEmpty());
  const std::vector<Seen> refused = only(FrameType::rst_stream, heard());
  ASSERT_THAT(refused, SizeIs(1));
  EXPECT_EQ(refused[0].payload, "\0\0\0\x07"s);
  grpc_says(answer(1, false));
  grpc_says(trailers(1));
  EXPECT_THAT(only(FrameType::headers, heard()), SizeIs(2)) << "what is open continues";
  EXPECT_EQ(fault(), "");
}

// grpc-go names one of its own streams in its GOAWAY, which RFC 9113, 6.8 does not allow.
TEST_F(ConversationTest, AClientThatTakesItsLeaveWronglyIsNoFault) {
  open();
  say(call(1, "/forward"));
  say(frame(FrameType::goaway, 0, 0, "\0\0\0\x01\0\0\0\0"s));
  heard();
  EXPECT_TRUE(conversation->over());
  EXPECT_EQ(fault(), "");
}

// Found by the fuzzer: the library wanted to write again after the end.
TEST_F(ConversationTest, WhatIsOverStaysOver) {
  open();
  say(goaway(0, ErrorCode::no_error, ""));
  heard();
  ASSERT_TRUE(conversation->over());
  conversation->announce_end();
  EXPECT_TRUE(conversation->over());
}

TEST_F(ConversationTest, AFaultAfterAFarewellIsOne) {
  open();
  say(call(1, "/forward"));
  say(frame(FrameType::goaway, 0, 0, "\0\0\0\0\0\0\0\0"s));
  say(frame(FrameType::ping, 0, 0, "short"));
  heard();
  EXPECT_TRUE(conversation->over());
  EXPECT_NE(fault(), "");
}

// The client may repeat the call, because gRPC has not seen it.
TEST_F(ConversationTest, WhatGrpcDidNotSeeIsRefused) {
  open();
  say(call(1, "/forward"));
  say(call(3, "/forward"));
  passed_on();
  grpc_says(goaway(1, ErrorCode::no_error, ""));
  const std::vector<Seen> resets = only(FrameType::rst_stream, heard());
  ASSERT_THAT(resets, SizeIs(1));
  EXPECT_EQ(resets[0].stream, 3u);
  EXPECT_EQ(number_at(resets[0].payload, 0), kRefusedStream);
}

TEST_F(ConversationTest, WhatIsNotHttp2IsNot) {
  begin();
  say("GET /metrics HTTP/1.1\r\n");
  EXPECT_EQ(fault(), "this is not HTTP/2");
  EXPECT_EQ(error_told(), kProtocolError);
}

TEST_F(ConversationTest, WhatIsNoCallOfGrpcIsRefusedAsItsProtocolSays) {
  open();
  Headers get = headers_for("/stop");
  get[0].value = "GET";
  say(frame(FrameType::headers, kEndHeaders | kEndStream, 1, encoder.encode(get)));
  EXPECT_EQ(find(headers_of(heard()[0]), ":status"), "405");
  Headers plain = headers_for("/stop");
  plain.back().value = "text/plain";
  say(frame(FrameType::headers, kEndHeaders | kEndStream, 3, encoder.encode(plain)));
  EXPECT_EQ(find(headers_of(heard()[0]), ":status"), "415");
  EXPECT_THAT(filter.decided, IsEmpty());
}

TEST_F(ConversationTest, MalformedHeadersResetTheirStreamAlone) {
  open();
  const std::vector<Headers> malformed = {{{":path", "/stop"}}, {{"Upper", "case"}}, {{"connection", "close"}},
                                          {{":unknown", "x"}},  {{"te", "gzip"}},    {{":status", "200"}}};
  std::uint32_t stream = 1;
  for (const Headers& more : malformed) {
    say(call(stream, "/stop", true, more));
    const std::vector<Seen> seen = heard();
    ASSERT_THAT(seen, SizeIs(1)) << testing::PrintToString(more[0].name);
    EXPECT_EQ(seen[0].type, FrameType::rst_stream);
    stream += 2;
  }
  EXPECT_THAT(filter.decided, IsEmpty());
  EXPECT_EQ(fault(), "");
}

TEST_F(ConversationTest, BrokenFramesEndTheConnection) {
  const std::vector<std::string> broken = {
      frame(FrameType::headers, kEndHeaders, 2, "\x82"),
      frame(FrameType::headers, kEndHeaders, 1, "\xff\xff\xff\xff\xff\xff"),
      frame(FrameType::continuation, kEndHeaders, 1, "a"),
      frame(FrameType::headers, 0, 1, "a") + frame(FrameType::ping, 0, 0, "12345678"),
      frame(FrameType::headers, kEndHeaders | 0x8, 1, "\x09"),
      frame(FrameType::ping, 0, 0, "1234567"),
      frame(FrameType::ping, 0, 1, "12345678"),
      frame(FrameType::data, 0, 7, "x"),
      window_update(7, 1),
      frame(FrameType::window_update, 0, 0, "\0\0\0\0"s),
      frame(FrameType::window_update, 0, 0, "\x7f\xff\xff\xff"s),
      frame(FrameType::settings, 0, 0, "12345"),
      settings_ack(),
      settings_frame({{2, 7}}),
      settings_frame({{5, 1}}),
      frame(FrameType::push_promise, 0, 1, "12345"),
      "\xff\xff\xff\0\0\0\0\0\1"s,
  };
  for (const std::string& bytes : broken) {
    open();
    say(bytes);
    EXPECT_NE(error_told(), 0u) << testing::PrintToString(bytes);
    ASSERT_TRUE(conversation->fault()) << testing::PrintToString(bytes);
    EXPECT_EQ(conversation->fault()->cause, Cause::protocol_error);
    EXPECT_TRUE(conversation->over());
  }
}

TEST_F(ConversationTest, AMessageThatIsTooLongIsRefusedByItself) {
  open();
  say(call(1, "/forward") + frame(FrameType::data, 0, 1, "\0\1\0\0\0"s + std::string(1000, 'x')));
  passed_on();
  const std::vector<Seen> seen = heard();
  EXPECT_THAT(std::string(find(headers_of(seen.at(0)), "grpc-message").value_or("")), HasSubstr("4194304 at most"));
  EXPECT_EQ(fault(), "");
  say(call(3, "/stop") + frame(FrameType::data, 0, 3, "\0\0\1\0\1"s));
  EXPECT_EQ(find(headers_of(heard().at(0)), "grpc-status"), "8");
}

}  // namespace
}  // namespace axisgate::front::conversation_test
