// Tests of the names by which people accept warnings.
#include "device/rml1/language/warning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace axisgate::rml1 {
namespace {

TEST(Warnings, HaveNamesOfTheirOwn) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < kWarnings; ++i) {
    const auto warning = static_cast<Warning>(i);
    EXPECT_TRUE(names.insert(name(warning)).second) << name(warning);
    EXPECT_EQ(warning_named(name(warning)), warning);
    EXPECT_THAT(name(warning), testing::MatchesRegex("[a-z-]+"));
    EXPECT_FALSE(remedy(warning).empty());
  }
}

TEST(Warnings, AreCalledAsTheManualOfTheUserSays) {
  EXPECT_EQ(name(Warning::deep_pass), "deep-pass");
  EXPECT_EQ(name(Warning::drags_home), "drags-home");
  EXPECT_EQ(name(Warning::tool_left_down), "tool-left-down");
  EXPECT_EQ(name(Warning::outside_stock), "outside-stock");
  EXPECT_EQ(name(Warning::made_for_another_mill), "made-for-another-mill");
}

TEST(Warnings, HaveNoOtherNames) {
  for (const char* text : {"", "all", "3-2", "warnings", "DEEP-PASS", "deep_pass"})
    EXPECT_FALSE(warning_named(text)) << text;
}

}  // namespace
}  // namespace axisgate::rml1
