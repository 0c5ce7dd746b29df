#include "server/recording/recording_ring.h"

#include <gmock/gmock.h>

#include <thread>

namespace axisgate::server::recording_ring_test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t kPortion = 1000;

const Executor kNobodyListens = [](std::function<void()>) {};

TEST(RecordingRing, ReadsEachLineOnceInPortionsOfWholeLines) {
  RecordingRing ring({}, kNobodyListens, 100);
  EXPECT_EQ(ring.read(ring.oldest().position, kPortion).text, "");
  ring.append("one");
  ring.append("two");
  ring.append("three");
  RecordingRing::Reading reading = ring.read(ring.oldest().position, 9);
  EXPECT_EQ(reading.text, "one\ntwo\n");
  EXPECT_EQ(reading.lost, 0u);
  reading = ring.read(reading.next, 9);
  EXPECT_EQ(reading.text, "three\n");
  EXPECT_EQ(reading.next, ring.newest());
  EXPECT_EQ(ring.read(reading.next, 9).text, "");
  ring.append("a line longer than the portion");
  EXPECT_EQ(ring.read(reading.next, 9).text, "a line longer than the portion\n");
}

TEST(RecordingRing, KeepsNoMoreThanItsBytesAndSaysWhatASlowReaderLost) {
  RecordingRing ring({}, kNobodyListens, 20);
  const RecordingRing::Position start = ring.oldest().position;
  for (int i = 0; i < 1000; ++i) ring.append(std::to_string(100 + i));
  const RecordingRing::Reading reading = ring.read(start, kPortion);
  EXPECT_EQ(reading.text, to_text(stage::RecordingHeader{}) + "1096\n1097\n1098\n1099\n");
  EXPECT_EQ(reading.lost, 996u);
  EXPECT_EQ(reading.next.line, 1000u);
  EXPECT_EQ(ring.read(ring.oldest().position, kPortion).lost, 0u);
}

TEST(RecordingRing, LinesOfAnyLengthPassTheEdge) {
  RecordingRing ring({}, kNobodyListens, 64);
  RecordingRing::Position position = ring.oldest().position;
  for (std::size_t i = 0; i < 500; ++i) {
    const std::string line(i % 63, static_cast<char>('a' + i % 26));
    ring.append(line);
    const RecordingRing::Reading reading = ring.read(position, kPortion);
    EXPECT_EQ(reading.text, line + "\n");
    EXPECT_EQ(reading.lost, 0u);
    position = reading.next;
  }
}

TEST(RecordingRing, ALineTooLongForAllIsCut) {
  RecordingRing ring({}, kNobodyListens, 8);
  ring.append("before");
  ring.append("0123456789");
  EXPECT_EQ(ring.read(ring.oldest().position, kPortion).text, "0123456\n");
}

TEST(RecordingRing, TheHeadKeepsWhatTheDroppedLinesTold) {
  RecordingRing ring({}, kNobodyListens, 40);
  ring.append("# 1.000000 link up 1,2");
  EXPECT_THAT(ring.oldest().header, Not(HasSubstr("# axes")));
  ring.append("2.000000 #1 < \"OK\\r\\n\" = ok");
  EXPECT_THAT(ring.oldest().header, HasSubstr("# axes: 1,2\n"));
  EXPECT_THAT(ring.read({}, kPortion).text, AllOf(HasSubstr("# axes: 1,2\n"), EndsWith("= ok\n")));
}

TEST(RecordingRing, WakesReaders) {
  RecordingRing ring(
      {}, [](const std::function<void()>& task) { task(); }, 100);
  int woken = 0;
  const auto subscription = ring.subscribe([&] { ++woken; });
  ring.append("one");
  EXPECT_EQ(woken, 1);
}

TEST(RecordingRing, ReadersOnOtherThreadsSeeEveryLineOrItsLoss) {
  RecordingRing ring({}, kNobodyListens, 2000);
  constexpr std::uint64_t kLines = 20'000;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < kLines; ++i) ring.append(std::to_string(i));
  });
  const std::string header = to_text(stage::RecordingHeader{});
  RecordingRing::Position position;
  std::uint64_t expected = 0;
  while (expected < kLines) {
    const RecordingRing::Reading reading = ring.read(position, 300);
    expected += reading.lost;
    const std::string text = reading.lost > 0 ? reading.text.substr(header.size()) : reading.text;
    if (!text.empty()) {
      ASSERT_EQ(text.substr(0, text.find('\n')), std::to_string(expected));
    }
    expected += reading.next.line - position.line - reading.lost;
    position = reading.next;
  }
  writer.join();
}

}  // namespace
}  // namespace axisgate::server::recording_ring_test
