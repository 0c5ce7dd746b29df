#include "device/core/line_framer.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

namespace axisgate::line_framer_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using namespace std::string_literals;
using namespace std::string_view_literals;

std::vector<std::string> drain(LineFramer& framer) {
  std::vector<std::string> lines;
  while (auto line = framer.next()) lines.push_back(line->text);
  return lines;
}

std::vector<std::string> lines_of(std::string_view bytes) {
  LineFramer framer;
  framer.push(bytes);
  return drain(framer);
}

TEST(LineFramer, EndsALineAtCrLfAtCrAndAtLf) {
  EXPECT_THAT(lines_of("OK\r\nNG\rOK_D\n"), ElementsAre("OK", "NG", "OK_D"));
}

TEST(LineFramer, DropsEmptyLines) { EXPECT_THAT(lines_of("\r\n\n\r\rOK\r\n\r\n  \r\n"), ElementsAre("OK")); }

TEST(LineFramer, HoldsBackAnIncompleteLine) {
  LineFramer framer;
  framer.push("O");
  EXPECT_THAT(drain(framer), IsEmpty());
  EXPECT_TRUE(framer.mid_line());
  framer.push("K\r");
  EXPECT_THAT(drain(framer), ElementsAre("OK"));
  EXPECT_FALSE(framer.mid_line());
  framer.push("\n");
  EXPECT_THAT(drain(framer), IsEmpty());
  EXPECT_FALSE(framer.mid_line());
}

TEST(LineFramer, GivesTheSameLinesHoweverTheBytesAreCut) {
  const std::string_view bytes = "+       200,-       200,+    100000,K,K,R\r\n1\r\nOK_D\r\n";
  const std::vector<std::string> whole = lines_of(bytes);
  ASSERT_THAT(whole, ElementsAre("+       200,-       200,+    100000,K,K,R", "1", "OK_D"));
  for (std::size_t cut = 0; cut <= bytes.size(); ++cut) {
    LineFramer framer;
    framer.push(bytes.substr(0, cut));
    framer.push(bytes.substr(cut));
    EXPECT_EQ(drain(framer), whole) << "cut at byte " << cut;
  }
}

TEST(LineFramer, StripsNulAndBlanksAroundALineOnly) {
  EXPECT_THAT(lines_of("\0\0 OK \0\0\r\n \0K, K, R\0\n"sv), ElementsAre("OK", "K, K, R"));
  EXPECT_THAT(lines_of("O\0K\r\n"sv), ElementsAre("O\0K"s));
}

TEST(LineFramer, PaddingAloneIsNotTheBeginningOfALine) {
  LineFramer framer;
  framer.push("\r\n\0\0 "sv);
  EXPECT_FALSE(framer.mid_line());
}

TEST(LineFramer, MarksALineOfMoreThan256BytesAndKeepsItsBeginning) {
  LineFramer framer;
  framer.push(std::string(256, 'a') + "\r\n" + std::string(257, 'b') + "\r\nOK\r\n");
  const auto longest = framer.next();
  ASSERT_TRUE(longest);
  EXPECT_EQ(longest->text, std::string(256, 'a'));
  EXPECT_FALSE(longest->overlong);
  const auto cut = framer.next();
  ASSERT_TRUE(cut);
  EXPECT_EQ(cut->text, std::string(256, 'b'));
  EXPECT_TRUE(cut->overlong);
  const auto after = framer.next();
  ASSERT_TRUE(after);
  EXPECT_EQ(after->text, "OK");
  EXPECT_FALSE(after->overlong);
}

TEST(LineFramer, PaddingDoesNotMakeALineOverlong) {
  LineFramer framer;
  framer.push(std::string(300, '\0') + std::string(256, 'a') + std::string(300, ' ') + "\r\n");
  const auto line = framer.next();
  ASSERT_TRUE(line);
  EXPECT_EQ(line->text, std::string(256, 'a'));
  EXPECT_FALSE(line->overlong);
}

TEST(LineFramer, KeepsThe1024OldestUnreadLines) {
  LineFramer framer;
  for (int i = 1; i <= 1030; ++i) framer.push(std::to_string(i) + "\r\n");
  const std::vector<std::string> lines = drain(framer);
  ASSERT_EQ(lines.size(), 1024u);
  EXPECT_EQ(lines.front(), "1");
  EXPECT_EQ(lines.back(), "1024");
  framer.push("again\r\n");
  EXPECT_THAT(drain(framer), ElementsAre("again"));
}

TEST(LineFramer, ClearForgetsLinesAndTheBeginningOfOne) {
  LineFramer framer;
  framer.push("OK\r\n" + std::string(300, 'x'));
  framer.clear();
  EXPECT_FALSE(framer.mid_line());
  framer.push("NG\r\n");
  const auto line = framer.next();
  ASSERT_TRUE(line);
  EXPECT_EQ(line->text, "NG");
  EXPECT_FALSE(line->overlong);
  EXPECT_FALSE(framer.next());
}

}  // namespace
}  // namespace axisgate::line_framer_test
