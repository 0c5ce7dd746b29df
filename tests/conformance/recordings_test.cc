// Replays every recording of a line, and expects that the present core does the same as the gateway did then.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <vector>

#include "device/shrc203/recording/replay.h"
#include "tests/paths/paths.h"

namespace axisgate::shrc203::conformance {
namespace {

struct File {
  std::string name, text;
};

void PrintTo(const File& file, std::ostream* out) { *out << file.name; }

// Returns every file of the folder, sorted by name.
const std::vector<File>& all_recordings() {
  static const std::vector<File> files = [] {
    std::vector<File> found;
    std::error_code error;
    const auto folder = paths::in_project("tests/conformance/recordings");
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
      std::ifstream stream(entry.path(), std::ios::binary);
      found.push_back({entry.path().filename().string(), {std::istreambuf_iterator<char>(stream), {}}});
    }
    std::ranges::sort(found, {}, &File::name);
    return found;
  }();
  return files;
}

// Returns a name for the test: GoogleTest accepts only letters, digits and underscores.
std::string test_name(const testing::TestParamInfo<File>& info) {
  std::string name = info.param.name.substr(0, info.param.name.find('.'));
  std::ranges::replace_if(
      name, [](unsigned char c) { return !std::isalnum(c); }, '_');
  return name;
}

Recording parsed(const File& file) {
  auto recording = parse_recording(file.text);
  if (!recording) ADD_FAILURE() << file.name << ": " << recording.error().message;
  return recording ? *std::move(recording) : Recording{};
}

// Returns the first difference; its line is 0 if there is none.
ReplayDifference first_difference(const Recording& recording) {
  const ReplayReport report = replay(recording);
  return report.differences.empty() ? ReplayDifference{} : report.differences.front();
}

// Text that is not an answer to any command.
constexpr std::string_view kNoAnswer = "?!\r\n";

class Recordings : public testing::TestWithParam<File> {};
// Two changed recordings, to show that a replay detects a difference.
class DoctoredRecordings : public testing::TestWithParam<File> {};

std::vector<File> to_be_doctored() {
  std::vector<File> files;
  for (const char* name : {"bad_line.recording", "good_line.recording"}) {
    const auto file = std::ranges::find(all_recordings(), name, &File::name);
    files.push_back(file == all_recordings().end() ? File{name, ""} : *file);
  }
  return files;
}

TEST_P(Recordings, AreDoneAgain) {
  const Recording recording = parsed(GetParam());
  const ReplayReport report = replay(recording);
  EXPECT_GT(report.first_line, 0) << "nowhere in it the line comes up, or is up while somebody asks";
  EXPECT_GT(report.exchanges, 0u);
  for (const auto& difference : report.differences) {
    ADD_FAILURE() << fmt::format("{}:{}: then it {}, now it {}", GetParam().name, difference.line, difference.recorded,
                                 difference.now);
  }
}

TEST_P(DoctoredRecordings, AreJudgedByEveryAnswer) {
  const Recording recording = parsed(GetParam());
  const int first = replay(recording).first_line;
  int changed = 0;
  for (std::size_t i = 0; i < recording.lines.size(); ++i) {
    const auto* exchange = std::get_if<RecordedExchange>(&recording.lines[i].event);
    if (!exchange || recording.lines[i].number < first) continue;
    const auto& items = exchange->items;
    const bool answered = items.back().kind == RecordedItem::Kind::ended && items.back().text != "timed_out";
    if (!answered || items.size() < 3) continue;
    Recording doctored = recording;
    auto& answer = std::get<RecordedExchange>(doctored.lines[i].event).items[items.size() - 2];
    ASSERT_EQ(answer.kind, RecordedItem::Kind::received);
    answer.text = kNoAnswer;
    EXPECT_EQ(first_difference(doctored).line, recording.lines[i].number) << GetParam().name;
    ++changed;
  }
  EXPECT_GT(changed, 0);
}

TEST_P(DoctoredRecordings, MissEveryExchangeThatIsTakenOut) {
  const Recording recording = parsed(GetParam());
  std::vector<std::size_t> exchanges;
  for (std::size_t i = 0; i < recording.lines.size(); ++i) {
    const auto* exchange = std::get_if<RecordedExchange>(&recording.lines[i].event);
    if (exchange && exchange->lane) exchanges.push_back(i);
  }
  ASSERT_GT(exchanges.size(), 2u);
  // The first and the last exchange are left out, because a recording may begin and end anywhere.
  for (std::size_t i = 1; i + 1 < exchanges.size(); ++i) {
    Recording doctored = recording;
    doctored.lines.erase(doctored.lines.begin() + static_cast<std::ptrdiff_t>(exchanges[i]));
    const int line = first_difference(doctored).line;
    EXPECT_GT(line, recording.lines[exchanges[i]].number) << GetParam().name;
    EXPECT_LE(line, recording.lines[exchanges[i + 1]].number) << GetParam().name;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Recordings, testing::ValuesIn(all_recordings()), test_name);
INSTANTIATE_TEST_SUITE_P(Ours, DoctoredRecordings, testing::ValuesIn(to_be_doctored()), test_name);

TEST(RecordingsFolder, HoldsRecordingsOnly) {
  EXPECT_FALSE(all_recordings().empty());
  for (const auto& file : all_recordings()) {
    EXPECT_TRUE(file.name.ends_with(".recording")) << file.name << " would not be known for one";
  }
}

}  // namespace
}  // namespace axisgate::shrc203::conformance
