#include <gmock/gmock.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "device/link/clock.h"
#include "server/metrics/metrics.h"
#include "server/recording/recorder.h"

namespace axisgate::server::server_recorder_test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class ServerRecorderTest : public ::testing::Test {
 protected:
  // Records one finished line.
  void record(const std::string& written) {
    recorder_.on_event(stage::BytesWritten{written, ++exchange_, "unix alice", Lane::question, {}}, monotonic_now());
    recorder_.flush();
  }

  std::string page() const { return prometheus::TextSerializer().Serialize(metrics_.registry()->Collect()); }

  Metrics metrics_;
  DeviceRecorder recorder_{recording_header({}, "shrc203"), [](std::function<void()>) {},
                           metrics_.recorder_drops("stage"), 2000};
  std::uint64_t exchange_ = 0;
};

TEST_F(ServerRecorderTest, AReaderGetsEachLineOnce) {
  record("Q:S\r\n");
  const RecordingRing::Beginning oldest = recorder_.ring().oldest();
  EXPECT_THAT(oldest.header, AllOf(StartsWith("# axisgate recording 1\n"), HasSubstr("# device: \"stage\"\n"),
                                   HasSubstr("# baud: 38400\n"), HasSubstr("# started: \"20")));
  DeviceRecorder::Reader reader(recorder_, oldest.position);
  EXPECT_THAT(reader.next(), EndsWith(" #1 question \"unix alice\" > \"Q:S\\r\\n\"\n"));
  EXPECT_THAT(reader.next(), IsEmpty());
  record("!:\r\n");
  EXPECT_THAT(reader.next(), EndsWith(" > \"!:\\r\\n\"\n"));
}

TEST_F(ServerRecorderTest, ABeginningIsBehindTheLineUnderWay) {
  recorder_.on_event(stage::BytesWritten{"Q:S\r\n", 1, "", Lane::poll, {}}, monotonic_now());
  EXPECT_EQ(recorder_.ring().newest().line, 0u);
  const RecordingRing::Beginning beginning = recorder_.begin();
  EXPECT_EQ(beginning.position.line, 1u);
  EXPECT_EQ(beginning.position, recorder_.ring().newest());
}

TEST_F(ServerRecorderTest, ASlowReaderIsToldWhatItLostAndBeginsAnew) {
  DeviceRecorder::Reader slow(recorder_, recorder_.ring().oldest().position);
  DeviceRecorder::Reader quick(recorder_, recorder_.ring().oldest().position);
  std::ptrdiff_t lines = 0;
  for (int i = 0; i < 100; ++i) {
    record("?:CMD\r\n");
    const std::string text = quick.next();
    lines += std::count(text.begin(), text.end(), '\n');
  }
  EXPECT_EQ(lines, 100);
  const std::uint64_t lost = recorder_.ring().oldest().position.line;
  ASSERT_GT(lost, 50u);
  EXPECT_THAT(slow.next(), StartsWith("# " + std::to_string(lost) +
                                      " lines lost: the reader was too slow\n# axisgate recording 1\n"));
  EXPECT_THAT(page(), HasSubstr("axisgate_recorder_dropped_total{device=\"stage\"} " + std::to_string(lost) + "\n"));
  record("!:\r\n");
  EXPECT_THAT(slow.next(), EndsWith(" > \"!:\\r\\n\"\n"));
}

}  // namespace
}  // namespace axisgate::server::server_recorder_test
