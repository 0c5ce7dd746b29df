// The table [jobs] of the configuration: how much space the jobs of mills may take, and how long they are kept.
#include <gmock/gmock.h>

#include <string>

#include "server/config/config.h"
#include "server/config/text.h"
#include "server/kinds.h"

namespace axisgate::server::config_jobs_test {
namespace {

using ::testing::HasSubstr;

Configured<Config> read(const std::string& lines) {
  return parse_config("[jobs]\n" + lines + "[[device]]\nname = \"stage\"\nconnection = \"simulated\"\n", "lab.toml",
                      device_kinds());
}

std::string first_error(const std::string& lines) {
  const auto config = read(lines);
  return config ? "it is read" : to_string(config.error().front());
}

TEST(ConfigJobs, Defaults) {
  const auto config = read("");
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(config->jobs.megabytes, 256);
  EXPECT_EQ(config->jobs.megabytes_each, 64);
  EXPECT_EQ(config->jobs.megabytes_per_person, 128);
  EXPECT_EQ(config->jobs.count, 200);
  EXPECT_EQ(config->jobs.count_per_person, 50);
  EXPECT_EQ(config->jobs.days, 30);
  EXPECT_EQ(config->jobs.confirm_days, 14);
}

TEST(ConfigJobs, IsReadAndWritten) {
  const std::string keys =
      "megabytes = 32\nmegabytes_each = 8\nmegabytes_per_person = 16\ncount = 50\ncount_per_person = 10\ndays = 7\n"
      "confirm_days = 21\n";
  const auto config = read(keys);
  ASSERT_TRUE(config) << to_string(config.error().front());
  EXPECT_EQ(config->jobs.megabytes, 32);
  EXPECT_EQ(config->jobs.megabytes_each, 8);
  EXPECT_EQ(config->jobs.megabytes_per_person, 16);
  EXPECT_EQ(config->jobs.count, 50);
  EXPECT_EQ(config->jobs.count_per_person, 10);
  EXPECT_EQ(config->jobs.days, 7);
  EXPECT_EQ(config->jobs.confirm_days, 21);
  EXPECT_THAT(to_toml(*config), HasSubstr("[jobs]\n" + keys));
}

TEST(ConfigJobs, OnePersonHasAQuarterOfTheQueue) {
  EXPECT_EQ(read("count = 10\n")->jobs.count_per_person, 2);
  EXPECT_EQ(read("count = 3\n")->jobs.count_per_person, 1);
  EXPECT_EQ(first_error("count = 10\ncount_per_person = 2\n"), "it is read");
  EXPECT_EQ(read("count = 400\ncount_per_person = 100\n")->jobs.count_per_person, 100);
}

TEST(ConfigJobs, WhatCannotBeIsRefusedWithItsLine) {
  EXPECT_EQ(first_error("days = 0\n"), "lab.toml:2: jobs.days: 0 is out of range; use a whole number from 1 to 36600");
  EXPECT_EQ(first_error("megabytes = 32\nmegabytes_each = 8\nmegabytes_per_person = 64\n"),
            "lab.toml:4: jobs.megabytes_per_person: 64 is more than all jobs may have; use at most megabytes = 32");
  EXPECT_EQ(first_error("megabytes_each = 200\n"),
            "lab.toml:2: jobs.megabytes_each: 200 is more than one person's jobs may have; use at most "
            "megabytes_per_person = 128");
  EXPECT_EQ(first_error("count = 10\ncount_per_person = 20\n"),
            "lab.toml:3: jobs.count_per_person: 20 is more than a quarter of count = 10; use at most 2");
  EXPECT_EQ(first_error("confirm_days = 366\n"),
            "lab.toml:2: jobs.confirm_days: 366 is out of range; use a whole number from 1 to 365");
  EXPECT_THAT(first_error("weeks = 2\n"), HasSubstr("lab.toml:2: jobs.weeks: is not a key here"));
}

}  // namespace
}  // namespace axisgate::server::config_jobs_test
