// Limits on the cost of a connection before it has to wait or is closed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <ostream>
#include <string>

#include "tests/unit/front/front_bed.h"

namespace axisgate::front::floods_test {
namespace {

using namespace std::string_literals;
using std::chrono::milliseconds;
using std::chrono::seconds;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

// A kind of flood, and the number of frames after which its connection must have ended.
struct Flood {
  const char* name;
  std::size_t bound;  // most frames
  std::string (*frames)(int number);
};
void PrintTo(const Flood& flood, std::ostream* out) { *out << flood.name; }

class FloodTest : public ConversationTest, public testing::WithParamInterface<Flood> {};

TEST_P(FloodTest, EndsItsConnectionSoon) {
  open();
  int sent = 0;
  std::size_t written = 0;
  std::uint32_t error = 0;
  while (!conversation->fault() && sent < 100'000) {
    now = std::max(now, conversation->not_before());
    say(GetParam().frames(sent++));
    const std::string told = conversation->take_to_client();
    written += told.size();
    for (const Seen& one : frames_in(client_reader, told)) {
      if (one.type == FrameType::goaway) error = number_at(one.payload, 4);
    }
    passed_on();
  }
  EXPECT_LE(static_cast<std::size_t>(sent), GetParam().bound);
  EXPECT_LT(written, 1u << 20);
  const std::string farewell = conversation->take_to_client();
  for (const Seen& one : frames_in(client_reader, farewell)) {
    if (one.type == FrameType::goaway) error = number_at(one.payload, 4);
  }
  ASSERT_TRUE(conversation->fault());
  EXPECT_EQ(error, static_cast<std::uint32_t>(ErrorCode::enhance_your_calm)) << fault();
  EXPECT_EQ(conversation->fault()->cause, Cause::over_budget);
}

Headers headers_of_call(const std::string& path) {
  return {{":method", "POST"},
          {":scheme", "http"},
          {":path", path},
          {":authority", "x"},
          {"content-type", "application/grpc"}};
}
std::string denied_call(int number) {
  const auto stream = static_cast<std::uint32_t>(2 * number + 1);
  return frame(FrameType::headers, kEndHeaders | kEndStream, stream, encode_without_table(headers_of_call("/denied")));
}
// Returns as many calls as one read delivers.
std::string denied_burst(int number) {
  std::string burst;
  for (int i = 0; i < 100; ++i) burst += denied_call(100 * number + i);
  return burst;
}
std::string begun_and_reset(int number) {
  const auto stream = static_cast<std::uint32_t>(2 * number + 1);
  return frame(FrameType::headers, kEndHeaders, stream, encode_without_table(headers_of_call("/forward"))) +
         rst_stream(stream, ErrorCode::no_error);
}
std::string continued(int number) {
  return number == 0 ? frame(FrameType::headers, 0, 1, "") : frame(FrameType::continuation, 0, 1, "");
}
std::string call_in_pieces() {
  return frame(FrameType::headers, kEndHeaders, 1, encode_without_table(headers_of_call("/forward")));
}
// Returns a call that ends with its answer, then frames that still arrive for the call; up to one stream window these
// are not charged as control frames.
std::string behind_its_end(int number, const std::string& frames) {
  const std::string call =
      frame(FrameType::headers, kEndHeaders | kEndStream, 1, encode_without_table(headers_of_call("/denied")));
  return number == 0 ? call : frames;
}

INSTANTIATE_TEST_SUITE_P(
    Front, FloodTest,
    testing::Values(Flood{"ping", 500, [](int) { return frame(FrameType::ping, 0, 0, "12345678"); }},
                    Flood{"settings", 20, [](int) { return settings_frame({}); }},
                    Flood{"ping_acks", 500, [](int) { return frame(FrameType::ping, kAck, 0, "12345678"); }},
                    Flood{"window_update", 500, [](int) { return window_update(0, 1); }},
                    Flood{"priority", 500, [](int) { return frame(FrameType::priority, 0, 3, "\0\0\0\0\0"s); }},
                    Flood{"unknown", 500, [](int) { return frame(static_cast<FrameType>(99), 0, 0, "x"); }},
                    Flood{"empty_data", 30'000,
                          [](int n) { return n == 0 ? call_in_pieces() : frame(FrameType::data, 0, 1, ""); }},
                    Flood{"padding", 30'000,
                          [](int n) { return n == 0 ? call_in_pieces() : frame(FrameType::data, 8, 1, "\3\0\0\0"s); }},
                    Flood{"data_behind_the_end", 10'000,
                          [](int n) { return behind_its_end(n, frame(FrameType::data, 0, 1, "x")); }},
                    Flood{"headers_behind_the_end", 10'000,
                          [](int n) { return behind_its_end(n, frame(FrameType::headers, kEndHeaders, 1, "")); }},
                    Flood{"denied_calls", 400, denied_burst}, Flood{"rapid_reset", 40'000, begun_and_reset},
                    Flood{"continuation", 10, continued}));

// Clients that watch over a connection without calls ping it about three times a minute.
TEST_F(ConversationTest, APingEvery20SecondsIsNoFlood) {
  open();
  say(call(1, "/refused"));
  for (int sent = 0; sent < 180; ++sent) {
    now += seconds(20);
    say(frame(FrameType::ping, 0, 0, "12345678"));
    ASSERT_FALSE(conversation->fault()) << fault() << " after " << sent << " pings";
    ASSERT_LE(conversation->not_before(), now) << "the connection waits after " << sent << " pings";
    conversation->check(now, true);
  }
}

// A dashboard with many streams acknowledges each message, on the stream and on the connection.
TEST_F(ConversationTest, WhatAcknowledgesMessagesIsNoFlood) {
  open();
  say(call(1, "/forward"));
  passed_on();
  grpc_says(answer(1, false));
  for (int i = 0; i < 15'000 && !conversation->fault(); ++i) {
    grpc_says(message(1, "event", false));
    passed_on();
    heard();
    say(window_update(1, 10) + window_update(0, 10));
    heard();
  }
  EXPECT_FALSE(conversation->fault()) << fault();
  for (int i = 0; i < 25'000 && !conversation->fault(); ++i) say(window_update(1, 1));
  EXPECT_TRUE(conversation->fault()) << "nothing was sent any more";
}

// Up to 128 KiB of headers, the other calls of the connection are not affected.
TEST_F(ConversationTest, HeadersThatAreTooLongAreRefusedByThemselves) {
  open();
  const auto long_call = [this](std::uint32_t stream, std::size_t size) {
    Headers headers = headers_of_call("/forward");
    for (; size > 0; size -= std::min<std::size_t>(size, 10'000)) headers.push_back({"x", std::string(10'000, 'a')});
    std::string frames;
    const std::string block = encode_without_table(headers);
    for (std::size_t at = 0; at < block.size(); at += 16'000) {
      const bool last = at + 16'000 >= block.size();
      frames += frame(at == 0 ? FrameType::headers : FrameType::continuation, last ? kEndHeaders : 0, stream,
                      block.substr(at, 16'000));
    }
    return frames;
  };
  say(long_call(1, 20'000));
  EXPECT_EQ(find(headers_of(heard().at(0)), "grpc-status"), "8");
  say(long_call(3, 120'000));
  EXPECT_EQ(find(headers_of(heard().at(0)), "grpc-status"), "8");
  EXPECT_EQ(fault(), "");
  EXPECT_THAT(filter.decided, IsEmpty());
}

// One byte of the block stands for a field of 38 bytes: the unpacked size and the number of fields count.
TEST_F(ConversationTest, HeadersCostWhatTheyAreUnpacked) {
  open();
  const auto bomb = [this](std::uint32_t stream) {
    std::string block = encoder.encode(headers_of_call("/forward"));
    block += "\x40\1a\0"s + std::string(16'000, '\xbe');
    return frame(FrameType::headers, kEndHeaders | kEndStream, stream, block);
  };
  std::uint32_t stream = 1;
  for (; conversation->not_before() <= now && stream < 100; stream += 2) say(bomb(stream));
  EXPECT_LE(stream, 2u * 9);  // calls of half a megabyte each, instead of 16 KiB
  EXPECT_THAT(filter.decided, IsEmpty());
  EXPECT_EQ(find(headers_of(heard().at(0)), "grpc-status"), "8");
}

TEST_F(ConversationTest, CallsBeyondTheBudgetWaitAndAreNotRefused) {
  open();
  say(call(1, "/forward"));
  std::uint32_t stream = 3;
  while (conversation->not_before() <= now && stream < 50'000) {
    say(call(stream, "/forward", true));
    passed_on();
    grpc_says(answer(stream, true));
    stream += 2;
    heard();
  }
  EXPECT_GT(stream, 2u * 8'000);
  EXPECT_LT(conversation->not_before() - now, milliseconds(2));
  EXPECT_FALSE(conversation->fault());
}

TEST_F(ConversationTest, RefusedCallsOneAfterTheOtherAreSlowedDown) {
  open();
  for (std::uint32_t stream = 1; stream < 1000; stream += 2) {
    now = std::max(now, conversation->not_before());
    say(call(stream, "/denied", true));
  }
  EXPECT_EQ(fault(), "");
  EXPECT_THAT(filter.decided, SizeIs(500));
  EXPECT_GT(now, TimePoint(seconds(5)));
}

TEST_F(ConversationTest, ConnectionsOfOneSourceShareItsBudget) {
  open();
  while (source->frames.take(Cost::settings, 1, now) <= Duration::zero()) continue;
  for (int i = 0; i < 20 && !conversation->fault(); ++i) say(settings_frame({}));
  EXPECT_THAT(fault(), HasSubstr("more frames a second"));
}

// The caller uses the same token from another machine: the address differs, the caller does not.
TEST_F(ConversationTest, ACallerHasOneBudgetWhateverItsConnections) {
  filter.caller = "token anna";
  open();
  say(call(1, "/forward"));
  sources.of("token anna", now)->frames.take(Cost::stream, 100'000, now);
  std::uint32_t stream = 3;
  while (conversation->not_before() <= now && stream < 1'000) {
    say(call(stream, "/forward"));
    stream += 2;
  }
  EXPECT_LT(stream, 2u * 50);  // the guaranteed part for a stop
  EXPECT_GT(conversation->not_before(), now + seconds(1));
  EXPECT_EQ(fault(), "");
}

TEST_F(ConversationTest, WhomNothingNamesPaysForNobodyElse) {
  open();
  say(call(1, "/forward"));
  sources.of("", now)->frames.take(Cost::stream, 100'000, now);
  for (std::uint32_t stream = 3; stream < 500; stream += 2) say(call(stream, "/forward"));
  EXPECT_LE(conversation->not_before(), now);
}

// Another connection of the same source uses up the whole budget.
TEST_F(ConversationTest, WhoDoesLittleIsNotHeldBackByOthersOfItsSource) {
  open();
  for (int number = 0; number < 10; ++number) {
    source->frames.take(Cost::stream, 100'000, now);
    source->frames.take(Cost::header_bytes, 100'000'000, now);
    source->frames.take(Cost::control, 1'000'000, now);
    say(call(static_cast<std::uint32_t>(2 * number + 1), "/stop") + frame(FrameType::ping, 0, 0, "12345678"));
    EXPECT_LE(conversation->not_before(), now);
  }
  EXPECT_EQ(fault(), "");
  for (int number = 10; conversation->not_before() <= now && number < 1000; ++number) {
    say(call(static_cast<std::uint32_t>(2 * number + 1), "/stop"));
  }
  EXPECT_GT(conversation->not_before(), now + seconds(1));
}

}  // namespace
}  // namespace axisgate::front::floods_test
