#include "device/core/escape.h"

#include <gtest/gtest.h>

namespace axisgate::escape_test {
namespace {

using namespace std::string_view_literals;

TEST(Escaped, LeavesPrintableAsciiAlone) {
  EXPECT_EQ(escaped("SIGMAKOKI,SHRC-203,2106001001,V2.00.000"), "SIGMAKOKI,SHRC-203,2106001001,V2.00.000");
  EXPECT_EQ(escaped(" ~\"'<>"), " ~\"'<>");
  EXPECT_EQ(escaped(""), "");
}

TEST(Escaped, NamesTerminatorsAndWritesOtherBytesInHexadecimal) {
  EXPECT_EQ(escaped("OK\r\n"), "OK\\r\\n");
  EXPECT_EQ(escaped("\0\x1b[2J\x7f\xff\t"sv), "\\x00\\x1B[2J\\x7F\\xFF\\x09");
}

TEST(Escaped, CannotBeMistakenForWhatItStandsFor) { EXPECT_EQ(escaped("\\x00"), "\\\\x00"); }

TEST(Escaped, IsAtMost80CharactersLong) {
  EXPECT_EQ(escaped(std::string(80, 'a')), std::string(80, 'a'));
  EXPECT_EQ(escaped(std::string(81, 'a')), std::string(77, 'a') + "...");
}

TEST(Escaped, IsNotCutWithinAnEscape) {
  EXPECT_EQ(escaped("ab\x01\x02", 10), "ab\\x01\\x02");
  EXPECT_EQ(escaped("ab\x01\x02", 9), "ab\\x01...");
  EXPECT_EQ(escaped("ab\x01\x02", 8), "ab...");
}

TEST(Escaped, KeepsEvenATinyLimit) {
  EXPECT_EQ(escaped("abcd", 3), "...");
  EXPECT_EQ(escaped("abcd", 2), "..");
  EXPECT_EQ(escaped("abcd", 0), "");
}

TEST(QuotedBytes, ComeBackWhateverTheyAre) {
  std::string all = "\"\\";
  for (int first = 0; first < 256; ++first) {
    all.push_back(static_cast<char>(first));
    const std::string one(1, static_cast<char>(first));
    const std::string text = quoted_bytes(one) + " rest";
    std::string_view rest = text;
    EXPECT_EQ(take_quoted_bytes(rest), one) << first;
    EXPECT_EQ(rest, " rest");
  }
  const std::string text = quoted_bytes(all);
  std::string_view rest = text;
  EXPECT_EQ(take_quoted_bytes(rest), all);
  EXPECT_EQ(rest, "");
}

TEST(QuotedBytes, AreNotTakenFromAnythingElse) {
  for (const std::string_view wrong : std::initializer_list<std::string_view>{
           "", "OK", "\"OK", "\"\\\"", "\"\\", "\"\\q\"", "\"\\x0\"", "\"\\xfF\"", "\"\n\"", "\"\xff\"", "\"\0\""sv}) {
    std::string_view rest = wrong;
    EXPECT_EQ(take_quoted_bytes(rest), std::nullopt) << escaped(wrong);
  }
  std::string_view rest = "\"OK\n\"";
  EXPECT_EQ(take_quoted_bytes(rest), std::nullopt);
  EXPECT_EQ(rest, "\n\"");
}

}  // namespace
}  // namespace axisgate::escape_test
