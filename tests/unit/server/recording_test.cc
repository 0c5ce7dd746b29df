// Format of a recording: written lines are read back byte for byte, and an error names its line.
#include "device/stage/recording/recording.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axisgate::stage::recording_test {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;
using Item = RecordedItem::Kind;
using Remark = RecordedRemark::Kind;

constexpr std::string_view kHeader =
    "# axisgate recording 1\n"
    "# kind: shrc203\n"
    "# device: \"stage\"\n"
    "# serial-number: \"2106001001\"\n"
    "# baud: 9600\n"
    "# reply-limit: 0.750000\n"
    "# started: \"2026-11-21T16:05:00Z\"\n"
    "# axes: 1,3\n"
    "# may-complete: 3\n";

constexpr std::string_view kBody =
    "# 0.000000 link connecting\n"
    "0.000000 - > \"*IDN?\\r\\n\" +0.010000 < \"SIGMAKOKI,SHRC-203,1,V2\\r\\n\"\n"
    "# 0.250000 barrier passed\n"
    "# 0.300000 link up 1,2,3\n"
    "# a note of somebody's\n"
    "1.000000 #7 motion \"lab\\\\\\\"x\\\"\" waited 0.004000 completes 1,2 > \"G:A\\r\\n\" +0.004212 < "
    "\"OK\\r\\n1\\r\\n\" = ok "
    "completion 1\n"
    "2.000000 #8 question \"\" closed > \"I:\\r\\n\" +0.500000 < \"\\x00z\" > \"!:S\\r\\n\" unexpected \"z\"\n"
    "3.000000 #8 = timed_out\n"
    "# 3.000000 barrier \"\\\"I:\\\" was not answered\"\n"
    "# 3.500000 same controller\n"
    "# 3.500000 ready 2\n"
    "# 3.500000 busy 1,3\n"
    "# 4.000000 link down \"pulled\"\n";

std::string mistake_in(std::string_view text) {
  const auto recording = parse_recording(text);
  return recording ? "" : recording.error().message;
}

std::string mistake_with(std::string_view right, std::string_view wrong) {
  std::string text = std::string(kHeader) + std::string(kBody);
  text.replace(text.find(right), right.size(), wrong);
  return mistake_in(text);
}

std::string text_of(const Recording& recording) {
  std::string text = to_text(recording.header);
  for (const auto& line : recording.lines) text += to_text(line.event) + "\n";
  return text;
}

TEST(Recording, IsWrittenAsItWasRead) {
  const std::string text = std::string(kHeader) + std::string(kBody);
  const auto recording = parse_recording(text);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(text_of(*recording), text);
}

TEST(Recording, TellsWhatItsTextSays) {
  const auto recording = parse_recording(std::string(kHeader) + std::string(kBody));
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(recording->header.device, "stage");
  EXPECT_EQ(recording->header.serial_number, "2106001001");
  EXPECT_EQ(recording->header.baud, 9600);
  EXPECT_EQ(recording->header.reply_limit, milliseconds(750));
  EXPECT_EQ(recording->header.axes, AxisSet::of(1) | AxisSet::of(3));
  EXPECT_EQ(recording->header.may_complete, AxisSet::of(3));
  ASSERT_EQ(recording->lines.size(), 13u);

  const auto& move = recording->lines[5];
  EXPECT_EQ(move.number, 15);
  RecordedExchange start;
  start.at = std::chrono::seconds(1);
  start.exchange = 7;
  start.lane = Lane::motion;
  start.who = "lab\\\"x\"";
  start.waited = milliseconds(4);
  start.completes = AxisSet::of(1) | AxisSet::of(2);
  start.items = {{{}, Item::written, "G:A\r\n"},
                 {microseconds(4212), Item::received, "OK\r\n1\r\n"},
                 {microseconds(4212), Item::ended, "ok"},
                 {microseconds(4212), Item::completion, "1"}};
  EXPECT_EQ(std::get<RecordedExchange>(move.event), start);

  const auto& input = std::get<RecordedExchange>(recording->lines[6].event);
  EXPECT_TRUE(input.closed);
  EXPECT_EQ(input.items[1].text, std::string("\0z", 2));
  EXPECT_EQ(std::get<RecordedExchange>(recording->lines[7].event).lane, std::nullopt);
  const RecordedRemark lost{milliseconds(4000), Remark::down, {}, "pulled"};
  EXPECT_EQ(std::get<RecordedRemark>(recording->lines[12].event), lost);
  EXPECT_EQ(std::get<RecordedRemark>(recording->lines[4].event).text, " a note of somebody's");
}

TEST(Recording, KeepsEveryByte) {
  RecordedExchange exchange;
  exchange.exchange = 1;
  exchange.lane = Lane::poll;
  std::string all;
  for (int byte = 0; byte < 256; ++byte) all.push_back(static_cast<char>(byte));
  exchange.who = all;
  exchange.items = {{{}, Item::written, all}, {{}, Item::received, "\"" + all + "\\"}};
  const std::string line = to_text(exchange);
  for (const char c : line) EXPECT_TRUE(c >= ' ' && c <= '~');
  const auto recording = parse_recording(std::string(kHeader) + line);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(std::get<RecordedExchange>(recording->lines[0].event), exchange);
}

TEST(Recording, CutsTimesOffAtMicroseconds) {
  RecordedExchange exchange;
  exchange.at = std::chrono::nanoseconds(1'000'000'999);
  exchange.items = {{std::chrono::nanoseconds(999), Item::received, "1"}};
  EXPECT_EQ(to_text(exchange), "1.000000 - < \"1\"");
}

TEST(Recording, MayHaveBeenSavedWithCrLf) {
  std::string text;
  for (const char c : std::string(kHeader) + std::string(kBody)) text += c == '\n' ? "\r\n" : std::string(1, c);
  const auto recording = parse_recording(text);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_EQ(text_of(*recording), std::string(kHeader) + std::string(kBody));
}

TEST(Recording, NamesTheLineOfAMistake) {
  EXPECT_THAT(mistake_in(""), HasSubstr("line 1: a recording begins with '# axisgate recording 1'"));
  EXPECT_THAT(mistake_in("# axisgate recording 2\n"), StartsWith("line 1: "));
  EXPECT_THAT(mistake_with("shrc203", "rml1"), StartsWith("line 2: 'rml1'"));
  EXPECT_THAT(mistake_with("9600", "96oo"), StartsWith("line 5: "));
  EXPECT_THAT(mistake_with("# baud:", "# buad:"), HasSubstr("the header lacks '# baud: ...'"));
  EXPECT_THAT(mistake_with("# reply-limit: 0.750000", "# baud: 9600"), StartsWith("line 6: 'baud' is given twice"));
  EXPECT_THAT(mistake_with("up 1,2,3", "up 1,2,9"), StartsWith("line 13: a number from 1 to 8 is due at '9'"));
  EXPECT_THAT(mistake_with("link up", "link upp"), StartsWith("line 13: "));
  EXPECT_THAT(mistake_with("barrier passed", "barrier over"), StartsWith("line 12: "));
  EXPECT_THAT(mistake_with("motion", "motoin"), StartsWith("line 15: 'motoin' is neither a lane nor"));
  EXPECT_THAT(mistake_with("= ok ", "= okay "), StartsWith("line 15: 'okay' is no outcome"));
  EXPECT_THAT(mistake_with("+0.004212 <", "+0.4212 <"), HasSubstr("six decimals"));
  EXPECT_THAT(mistake_with("completion 1", "completion 9"), StartsWith("line 15: "));
  EXPECT_THAT(mistake_with("> \"G:A\\r\\n\"", "> \"G:A\\r\\n"), StartsWith("line 15: "));
  EXPECT_THAT(mistake_with("> \"G:A\\r\\n\" +0.004212 ", ""), HasSubstr("begins with what was written"));
  EXPECT_THAT(mistake_with("\\x00", "\\x0"), StartsWith("line 16: a text between double quotes is due"));
  EXPECT_THAT(mistake_with("#7", "#0"), StartsWith("line 15: "));
  EXPECT_THAT(mistake_with("#8 =", "8 ="), StartsWith("line 17: "));
  EXPECT_THAT(mistake_with("= timed_out", "= timed_out "), StartsWith("line 17: "));
}

TEST(Recording, RunsForwards) {
  EXPECT_THAT(mistake_with("3.000000 #8", "1.900000 #8"), HasSubstr("line 17: time runs backwards"));
  EXPECT_THAT(mistake_with("> \"!:S", "+0.400000 > \"!:S"), HasSubstr("line 16: time runs backwards"));
}

TEST(Recording, WhatBeginsLaterIsHeadedByWhatIsKnownThen) {
  RecordingHeader header;
  pass(header, "# 0.300000 link up 1,2");
  EXPECT_EQ(header.axes, AxisSet::of(1) | AxisSet::of(2));
  pass(header, "1.000000 #7 motion \"lab\" completes 1,2 > \"G:A\\r\\n\"");
  pass(header, "# 1.500000 ready 2");
  EXPECT_EQ(header.may_complete, AxisSet::of(1));
  pass(header, "# whatever somebody notes");
  EXPECT_EQ(header.may_complete, AxisSet::of(1));
  pass(header, "# 2.000000 link down \"pulled\"");
  EXPECT_EQ(header.axes, std::nullopt);
  EXPECT_TRUE(header.may_complete.empty());
}

}  // namespace
}  // namespace axisgate::stage::recording_test
