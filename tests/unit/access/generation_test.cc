// The generation in fencing tokens, which grows with every start of the daemon.
#include "server/access/generation.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace axisgate::server::generation_test {
namespace {

constexpr std::uint32_t kNow = 1'000'000;

class Generation : public testing::Test {
 protected:
  Generation() : folder_(testing::TempDir() + "axisgate-generation-" + std::to_string(::getpid())) {
    std::filesystem::remove_all(folder_);
  }
  ~Generation() override { std::filesystem::remove_all(folder_); }

  const std::string folder_;
};

TEST_F(Generation, GrowsWithEveryStart) {
  const auto first = next_generation(folder_, kNow), second = next_generation(folder_, kNow);
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(first->kept && second->kept);
  EXPECT_EQ(first->number, kNow);
  EXPECT_EQ(second->number, kNow + 1);
}

TEST_F(Generation, AClockThatWasSetBackDoesNotMatter) {
  ASSERT_TRUE(next_generation(folder_, kNow));
  EXPECT_EQ(next_generation(folder_, 5).value().number, kNow + 1);
}

TEST_F(Generation, IsGreaterThanThatOfAStartThatCouldNotKeepIt) {
  ASSERT_TRUE(next_generation(folder_, kNow));
  EXPECT_EQ(next_generation(folder_, kNow + 100).value().number, kNow + 100);
}

TEST_F(Generation, ADirectoryThatCannotBeIsSaid) {
  std::ofstream(folder_) << "a file";
  const auto refused = next_generation(folder_, kNow);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find(folder_ + "/generation"), std::string::npos) << refused.error().message;
}

TEST_F(Generation, WhatCannotBeKeptIsGreaterAllTheSame) {
  ASSERT_TRUE(next_generation(folder_, kNow));
  std::filesystem::create_directory(folder_ + "/generation.new");
  const auto second = next_generation(folder_, 5);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->number, kNow + 1);
  ASSERT_FALSE(second->kept);
  EXPECT_EQ(second->kept.error().message, "cannot write " + folder_ + "/generation.new: File exists");
}

}  // namespace
}  // namespace axisgate::server::generation_test
