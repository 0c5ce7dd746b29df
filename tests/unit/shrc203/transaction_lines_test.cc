// Errors in a caller's own lines that the text of the lines shows.
#include "device/shrc203/planning/transaction_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace axisgate::shrc203::transaction_lines_test {
namespace {

using testing::Not;
using testing::StartsWith;

TEST(CheckLines, NamesTheLineAmongSeveral) {
  EXPECT_THAT(check_lines({"?:V", "X:1"}).error().message, StartsWith("line 2: "));
  EXPECT_THAT(check_lines({"X:1", "?:V"}).error().message, StartsWith("line 1: "));
  EXPECT_THAT(check_lines({"X:1"}).error().message, Not(StartsWith("line")));
  EXPECT_TRUE(check_lines({"?:V"}));
}

}  // namespace
}  // namespace axisgate::shrc203::transaction_lines_test
