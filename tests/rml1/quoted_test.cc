// Tests that errors quote the bytes that they refer to.
#include "device/rml1/language/quoted.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/rml1/trace.h"

namespace axisgate::rml1 {
namespace {

std::string error_of(const std::string& job) { return play(job, test_profile()).diagnostics.at(0).text; }

TEST(Quoted, AreBytesAsTheyCanBeRead) {
  EXPECT_EQ(in_quotes("PD 1,2"), "\"PD 1,2\"");
  EXPECT_EQ(in_quotes("\x1B\xC3\xA9~\x7F"), "\"\\x1B\\xC3\\xA9~\\x7F\"");
  EXPECT_EQ(in_quotes(std::string(24, 'a')), "\"" + std::string(24, 'a') + "\"");
  EXPECT_EQ(in_quotes(std::string(25, 'a')), "\"" + std::string(24, 'a') + "...\"");
}

TEST(Quoted, IsWhatIsWrong) {
  EXPECT_EQ(error_of("100,-200;"), "a number where a command is expected: \"100,-200\"");
  EXPECT_EQ(error_of("5"), "a number where a command is expected: \"5\"");
  EXPECT_EQ(error_of(std::string(40, '7') + ";"),
            "a number where a command is expected: \"" + std::string(24, '7') + "...\"");
  EXPECT_EQ(error_of("!XY;"), "there is no command \"!XY\"");
  EXPECT_EQ(error_of("!;"), "there is no command \"!\"");
  EXPECT_EQ(error_of("\x7F;"), "there is no command \"\\x7F\"");
  EXPECT_EQ(error_of("\xE9;"), "a byte of 0x80 or more is no part of RML-1: \"\\xE9\"");
  EXPECT_EQ(error_of("PD1,2,3;"), "PD takes sets of 2 numbers: 3 is left of a set, and not executed");
  EXPECT_EQ(error_of("Z1,2,3,4,5;"), "Z takes sets of 3 numbers: 4,5 is left of a set, and not executed");
  EXPECT_EQ(error_of("W40000;"), "W takes 0 to 32767: 40000 is not used");
  EXPECT_EQ(error_of("F40000;"), "F takes -32768 to 32767: 32767 is used instead of 40000");
}

}  // namespace
}  // namespace axisgate::rml1
