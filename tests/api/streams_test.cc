// Tests of the limits for streams, in total and for each caller, and of the end of streams when the daemon ends.
#include "server/api/request/streams.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace axisgate::api::streams_test {
namespace {

using testing::HasSubstr;

const std::string kAnna = "unix anna", kBen = "token ben";

TEST(StreamsTest, PathsHaveALimitOfTheirOwn) {
  Streams streams({.streams = 3, .outcomes_kept = 0, .paths = 1});
  auto path = streams.take(RequestKind::run_path, kAnna);
  ASSERT_TRUE(path);
  EXPECT_EQ(streams.take(RequestKind::run_path, kBen).error().reason, Reason::queue_full);
  auto first = streams.take(RequestKind::jog, kAnna), second = streams.take(RequestKind::watch_device, kAnna);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(streams.take(RequestKind::execute, kBen).error().reason, Reason::queue_full);
  first->reset();
  EXPECT_TRUE(streams.take(RequestKind::execute, kAnna));
  path->reset();
  EXPECT_TRUE(streams.take(RequestKind::run_path, kAnna));
}

TEST(StreamsTest, OneCallerLeavesPathsForOthers) {
  Streams streams({.paths = 3, .paths_of_one = 2});
  const auto first = streams.take(RequestKind::run_path, kAnna);
  auto second = streams.take(RequestKind::run_path, kAnna);
  const auto third = streams.take(RequestKind::run_path, kAnna);
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error().message, "unix anna has 2 paths open, and one caller may have no more");
  EXPECT_TRUE(streams.take(RequestKind::run_path, kBen));
  second->reset();
  EXPECT_TRUE(streams.take(RequestKind::run_path, kAnna));
}

TEST(StreamsTest, SomeAreKeptForOutcomes) {
  Streams streams({.streams = 3, .outcomes_kept = 1});
  const auto first = streams.take(RequestKind::watch_device, kAnna);
  const auto second = streams.take(RequestKind::watch_events, kBen);
  const auto refused = streams.take(RequestKind::watch_device, kBen);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("the last 1 are for those that follow one motion"));
  const auto outcome = streams.take(RequestKind::watch_motion, kBen);
  EXPECT_TRUE(outcome);
  EXPECT_FALSE(streams.take(RequestKind::watch_motion, kBen));
}

TEST(StreamsTest, CuttingACallerOffEndsTheirStreamsAndNobodyElses) {
  Streams streams;
  std::vector<std::string> ended;
  const auto annas = *streams.take(RequestKind::watch_device, kAnna);
  const auto bens = *streams.take(RequestKind::watch_device, kBen);
  const auto late = *streams.take(RequestKind::jog, kBen);
  annas->on_cut_off([&] { ended.push_back("anna's"); });
  bens->on_cut_off([&] { ended.push_back("ben's"); });
  const Problem why{.reason = Reason::unauthenticated, .message = "revoked"};
  streams.cut_off(kBen, why);
  streams.cut_off(kBen, why);
  late->on_cut_off([&] { ended.push_back("ben's that was not open yet"); });
  EXPECT_EQ(ended, (std::vector<std::string>{"ben's", "ben's that was not open yet"}));
  EXPECT_FALSE(annas->cut_off());
  EXPECT_EQ(bens->cut_off()->why.message, "revoked");
  EXPECT_FALSE((*streams.take(RequestKind::jog, kBen))->cut_off());
}

TEST(StreamsTest, AtTheEndOfTheDaemonAllEndAndNoMoreBegin) {
  Streams streams;
  int ended = 0;
  const auto annas = *streams.take(RequestKind::watch_device, kAnna), bens = *streams.take(RequestKind::jog, kBen);
  for (const auto& stream : {annas, bens}) stream->on_cut_off([&] { ++ended; });
  EXPECT_FALSE(streams.ending());
  streams.end_all();
  EXPECT_EQ(streams.ending()->reason, Reason::daemon_ending);
  EXPECT_EQ(ended, 2);
  EXPECT_EQ(annas->cut_off()->why.reason, Reason::daemon_ending);
  EXPECT_EQ(streams.take(RequestKind::watch_motion, kAnna).error().reason, Reason::daemon_ending);
}

}  // namespace
}  // namespace axisgate::api::streams_test
