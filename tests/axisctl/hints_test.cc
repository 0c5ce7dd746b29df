// Tests of the daemon's hints in the words of axisctl.
#include "clients/axisctl/hints.h"

#include <gtest/gtest.h>

namespace axisgate::axisctl {
namespace {

TEST(Hints, NameCommandsInsteadOfCalls) {
  EXPECT_EQ(with_commands("`ListPositions` lists them; `DeletePosition` deletes one", 0),
            "`axisctl positions` lists them; `axisctl forget` deletes one");
}

TEST(Hints, ACallWithAFieldIsAnotherCommand) {
  EXPECT_EQ(with_commands("wake it up: `ChangeSettings` with `sleeping`", 0), "wake it up: `axisctl wake`");
}

TEST(Hints, TheCommandHasTheAxis) {
  EXPECT_EQ(with_commands("home it first: `Home`", 2), "home it first: `axisctl home 2`");
  EXPECT_EQ(with_commands("home it first: `Home`", 0), "home it first: `axisctl home AXIS`");
}

TEST(Hints, AFieldThatIsAnOptionBecomesTheOption) {
  EXPECT_EQ(with_commands("accept what is right: `accepted_warnings` deep-pass", 0),
            "accept what is right: --accept deep-pass");
  EXPECT_EQ(with_commands("to wait, acquire a lease with `wait`; or stop it", 0),
            "to wait, add --wait SECONDS; or stop it");
}

TEST(Hints, ACallWithoutACommandStays) { EXPECT_EQ(with_commands("see `GetSomething`", 0), "see `GetSomething`"); }

}  // namespace
}  // namespace axisgate::axisctl
