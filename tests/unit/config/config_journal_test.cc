// The table [journal] of the configuration: who may read the entries of other callers.
#include <gmock/gmock.h>

#include <string>

#include "server/config/config.h"
#include "server/config/text.h"
#include "server/kinds.h"

namespace axisgate::server::config_journal_test {
namespace {

using ::testing::HasSubstr;

Configured<Config> read(const std::string& lines) {
  return parse_config("[journal]\n" + lines + "[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n", "lab.toml",
                      device_kinds());
}

TEST(ConfigJournal, EverybodyReadsAllUnlessSaidOtherwise) {
  const auto config = read("");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(config->journal.others_seen_by, Role::observer);
}

TEST(ConfigJournal, TheRoleIsReadAndWritten) {
  const auto config = read("others_seen_by = \"admin\"\n");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(config->journal.others_seen_by, Role::admin);
  EXPECT_THAT(to_toml(*config), HasSubstr("\nothers_seen_by = \"admin\"\n"));
}

TEST(ConfigJournal, WhatIsNoSuchRoleIsRefusedWithItsLine) {
  for (const std::string word : {"nobody", "everybody"}) {
    const auto config = read("days = 30\nothers_seen_by = \"" + word + "\"\n");
    ASSERT_FALSE(config) << word;
    EXPECT_EQ(to_string(config.error().front()),
              "lab.toml:3: journal.others_seen_by: \"" + word +
                  "\" is not known; use one of \"observer\", \"operator\", \"admin\"");
  }
}

}  // namespace
}  // namespace axisgate::server::config_journal_test
