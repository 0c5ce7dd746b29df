// Tests of the live display, and of the message at Ctrl-C.
#include "clients/axisctl/live_display.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <string>

#include "clients/axisctl/interrupt.h"
#include "tests/axisctl/terminal.h"

namespace axisgate::axisctl {
namespace {

// Only one row of a terminal can be rewritten.
TEST(LiveRow, IsNotWiderThanTheTerminal) {
  const std::string expected = "01234567890123456789\r\x1b[K";
  std::string shown;
  {
    Terminal terminal(STDOUT_FILENO, 20);
    LiveDisplay().in_place("0123456789012345678901234567");
    shown = terminal.read(expected.size());
  }
  EXPECT_EQ(shown, expected);
}

TEST(Interrupt, SaysWhatContinues) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto interrupted = [] {
    say_on_interrupt("the job continues");
    ::raise(SIGINT);
  };
  EXPECT_EXIT(interrupted(), ::testing::ExitedWithCode(130), "^\naxisctl: the job continues\n$");
}

}  // namespace
}  // namespace axisgate::axisctl
