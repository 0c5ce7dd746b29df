// The command table as people see it.
#include "device/shrc203/command/listing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "device/shrc203/command/command_table.h"

namespace axisgate::shrc203::listing_test {
namespace {

using testing::ElementsAre;

stage::CommandInfo listed(std::string_view name) {
  const auto list = list_commands();
  const auto found = std::ranges::find(list, name, &stage::CommandInfo::name);
  return found == list.end() ? stage::CommandInfo{} : *found;
}

TEST(Listing, HasTheWholeTable) { EXPECT_EQ(list_commands().size(), model().commands().size()); }

TEST(Listing, SaysWhatParametersMayBe) {
  const stage::CommandInfo trigger = listed("T:P");
  EXPECT_EQ(trigger.format, "T:P<a>P<b>");
  EXPECT_EQ(trigger.description, "trigger output: every so many drive pulses of an axis");
  EXPECT_THAT(trigger.parameters, ElementsAre("a: axis", "b: interval; 2 to 30000 pulses"));
  EXPECT_EQ(trigger.section, "98)");
  EXPECT_EQ(trigger.lane, Lane::motion);
  EXPECT_FALSE(trigger.moves);
  EXPECT_TRUE(listed("G:").moves);
  EXPECT_EQ(listed("L:").lane, Lane::stop);
}

// A name that begins no row would restrict nothing.
TEST(AdminCommands, EachBeginsACommand) {
  for (const auto& [name, request] : admin_commands()) {
    const auto begins = [&](const CommandRow& row) { return row.name.starts_with(name); };
    EXPECT_TRUE(std::ranges::any_of(model().commands(), begins)) << name;
  }
  EXPECT_EQ(admin_commands().size(), 6u);
}

}  // namespace
}  // namespace axisgate::shrc203::listing_test
