#include "server/recording/recording_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

#include "device/link/clock.h"
#include "server/metrics/metrics.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::server::recording_file_test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr auto kRetryPause = std::chrono::milliseconds(1);
constexpr std::uint64_t kBytesMax = 64 << 20;

class RecordingFileTest : public ::testing::Test {
 protected:
  void record(const std::string& written) {
    recorder_.on_event(stage::BytesWritten{written, 1, "", Lane::question, {}}, monotonic_now());
    recorder_.flush();
  }

  static std::string content(const std::filesystem::path& path) {
    std::stringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
  }

  static void wait_for(const std::filesystem::path& path, const std::string& text) {
    const TimePoint limit = monotonic_now() + link_test::kPatience;
    while (content(path).find(text) == std::string::npos) {
      ASSERT_LT(monotonic_now(), limit) << content(path);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  link_test::TemporaryDirectory directory_;
  const std::filesystem::path path_ = directory_ / "stage.recording";
  Metrics metrics_;
  DeviceRecorder recorder_{recording_header({}, "shrc203"), [](const std::function<void()>& task) { task(); },
                           metrics_.recorder_drops("stage")};
};

TEST_F(RecordingFileTest, IsWrittenAsTheLineGoesAndTakenUpAgain) {
  {
    const RecordingFile file(path_, recorder_, kBytesMax, kRetryPause);
    record("Q:S\r\n");
    wait_for(path_, "Q:S");
    record("!:\r\n");
  }
  EXPECT_THAT(content(path_),
              AllOf(StartsWith("# axisgate recording 1\n"), HasSubstr("Q:S"), EndsWith(" > \"!:\\r\\n\"\n")));
  const std::string first = content(path_);
  { const RecordingFile file(path_, recorder_, kBytesMax, kRetryPause); }
  EXPECT_THAT(content(path_), StartsWith(first + "\n# axisgate recording 1\n"));
}

TEST_F(RecordingFileTest, IsTriedAgainUntilItCanBeWritten) {
  const std::filesystem::path later = path_.parent_path() / "made-later" / "stage.recording";
  const RecordingFile file(later, recorder_, kBytesMax, kRetryPause);
  record("Q:S\r\n");
  std::filesystem::create_directory(later.parent_path());
  wait_for(later, "Q:S");
}

TEST_F(RecordingFileTest, TwoFilesHaveNoMoreThanTheirBytes) {
  DeviceRecorder recorder(
      recording_header({}, "shrc203"), [](const std::function<void()>& task) { task(); },
      metrics_.recorder_drops("stage"), 4096);
  constexpr std::uint64_t kSmall = 64 << 10;
  {
    const RecordingFile file(path_, recorder, kSmall, kRetryPause);
    for (std::uint64_t i = 1; i <= 5000; ++i) {
      recorder.on_event(stage::BytesWritten{fmt::format("?:P{}\r\n", i), i, "", Lane::question, {}}, monotonic_now());
      recorder.flush();
      if (i % 20 == 0) wait_for(path_, fmt::format("?:P{}\\r", i));
    }
  }
  const std::string before = content(path_.string() + ".1"), now = content(path_);
  EXPECT_THAT(before, StartsWith("# axisgate recording 1\n"));
  EXPECT_THAT(now, AllOf(StartsWith("# axisgate recording 1\n"), HasSubstr("?:P5000\\r")));
  EXPECT_GT(before.size(), kSmall / 2);
  EXPECT_LT(before.size() + now.size(), kSmall + (8 << 10));
}

TEST_F(RecordingFileTest, AFullDiskHoldsUpNobody) {
  const RecordingFile file("/dev/full", recorder_, kBytesMax, kRetryPause);
  for (int i = 0; i < 1000; ++i) record("Q:S\r\n");
  EXPECT_EQ(recorder_.ring().newest().line, 1000u);
}

}  // namespace
}  // namespace axisgate::server::recording_file_test
