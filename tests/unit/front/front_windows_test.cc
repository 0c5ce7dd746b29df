// Amount of data that each side lets the other send (RFC 9113, 5.2), and the order in which answers are sent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/unit/front/front_bed.h"

namespace axisgate::front::windows_test {
namespace {

using namespace std::string_literals;
using testing::IsEmpty;

std::size_t data_bytes(const std::vector<Seen>& seen) {
  std::size_t bytes = 0;
  for (const Seen& one : only(FrameType::data, seen)) bytes += one.payload.size();
  return bytes;
}

class FrontWindowsTest : public ConversationTest {};

// Each side counts its own windows.
TEST_F(FrontWindowsTest, TheClientsWindowHoldsGrpcBackAndNotAStop) {
  open();
  say(call(1, "/forward", true));
  passed_on();
  std::size_t delivered = 0, told = 0;
  grpc_says(answer(1, false));
  for (int i = 0; i < 100; ++i) {
    const std::vector<Seen> given = only(FrameType::window_update, passed_on());
    for (const Seen& one : given) {
      if (one.stream == 1) told += number_at(one.payload, 0);
    }
    // At most 32 KiB, plus what the windows have allowed since, may be in flight.
    if (32'768 + told < (static_cast<std::size_t>(i) + 1) * 10'000) break;
    grpc_says(frame(FrameType::data, 0, 1, std::string(10'000, 'x')));
    delivered += data_bytes(heard());
  }
  EXPECT_EQ(delivered, 65'535u);  // the client's window
  say(call(3, "/stop") + message(3, "halt") + window_update(0, 100));
  heard();
  filter.asked[0].second({.body = "stands"});
  const std::vector<Seen> seen = heard();
  EXPECT_EQ(data_bytes(seen), 11u);
  EXPECT_TRUE(seen.back().ends_stream());
}

TEST_F(FrontWindowsTest, AStopIsAnsweredAheadOfADownload) {
  open();
  say(call(1, "/forward", true) + window_update(0, 1 << 20) + window_update(1, 1 << 20));
  passed_on();
  grpc_says(answer(1, false) + frame(FrameType::data, 0, 1, std::string(16'384, 'x')) +
            frame(FrameType::data, 0, 1, std::string(16'384, 'x')));
  say(call(3, "/stop") + message(3, "halt"));
  filter.asked[0].second({.body = "stands"});
  const std::vector<Seen> seen = only(FrameType::data, heard());
  EXPECT_EQ(seen.at(0).stream, 3u);
}

// Otherwise gRPC's session would count bytes that gRPC never sent, and end at 2 GiB.
TEST_F(FrontWindowsTest, TheFrontsOwnAnswersAreNotGrpcs) {
  open();
  say(call(1, "/forward") + window_update(0, 0x7000'0000) + settings_frame({{4, 0x7fff'0000}}));
  passed_on();
  passed_on();
  for (std::uint32_t stream = 3; stream < 900; stream += 2) {
    say(call(stream, "/ask") + message(stream, "?"));
    filter.asked.back().second({.body = std::string(60'000, 'x')});
    heard();
  }
  grpc_says(answer(1, false) + frame(FrameType::data, 0, 1, std::string(10'000, 'x')));
  heard();
  EXPECT_THAT(only(FrameType::window_update, passed_on()), IsEmpty()) << "half a window is not used yet";
}

// Data that gRPC does not accept must not open the client's window again.
TEST_F(FrontWindowsTest, GrpcHoldsTheClientBack) {
  open();
  say(call(1, "/forward") + frame(FrameType::data, 0, 1, "\0\0\x10\0\0"s));
  std::size_t passed = data_bytes(passed_on()), sent = 5, told = 0;
  for (int i = 0; i < 20 && sent + 10'000 <= 65'536 + told; ++i) {
    say(frame(FrameType::data, 0, 1, std::string(10'000, 'x')));
    sent += 10'000;
    passed += data_bytes(passed_on());
    for (const Seen& one : only(FrameType::window_update, heard())) {
      if (one.stream == 1) told += number_at(one.payload, 0);
    }
  }
  EXPECT_EQ(passed, 65'535u);  // gRPC's window
  EXPECT_LT(sent, 65'536u * 2 + 10'000);
  grpc_says(window_update(1, 1 << 20) + window_update(0, 1 << 20));
  EXPECT_EQ(data_bytes(passed_on()), sent - 65'535);
}

// Otherwise the connection's window would shrink with each call.
TEST_F(FrontWindowsTest, WhatACallDidNotUseIsGivenBackToItsConnection) {
  open();
  std::size_t told = 0;
  for (std::uint32_t stream = 1; stream < 1'000; stream += 2) {
    say(call(stream, "/forward") + frame(FrameType::data, 0, stream, "\0\0\x10\0\0"s + std::string(10'000, 'x')));
    say(rst_stream(stream, ErrorCode::no_error));
    for (const Seen& one : only(FrameType::window_update, heard())) {
      if (one.stream == 0) told += number_at(one.payload, 0);
    }
  }
  EXPECT_EQ(fault(), "");
  EXPECT_GT(told, 4'000'000u);  // of five million
}

}  // namespace
}  // namespace axisgate::front::windows_test
