#include "server/spare_memory.h"

#include <gtest/gtest.h>

namespace axisgate::server {
namespace {

constexpr std::size_t kMiB = 1 << 20;

class SpareMemoryTest : public testing::Test {
 protected:
  std::size_t unused_ = 0;
  int given_back_ = 0;
  SpareMemory memory_{{[this] { return unused_; }, [this] { ++given_back_; }}};

  int looks_at(std::size_t unused) {
    unused_ = unused;
    memory_.look();
    return given_back_;
  }
};

TEST_F(SpareMemoryTest, ALittleIsKept) { EXPECT_EQ(looks_at(SpareMemory::kWorthIt - 1), 0); }

TEST_F(SpareMemoryTest, MuchIsGivenBackOnce) {
  EXPECT_EQ(looks_at(50 * kMiB), 1);
  EXPECT_EQ(looks_at(50 * kMiB), 1);
  EXPECT_EQ(looks_at(51 * kMiB), 1);
}

TEST_F(SpareMemoryTest, WhatWasUsedMeanwhileIsGivenBackAgain) {
  EXPECT_EQ(looks_at(50 * kMiB), 1);
  EXPECT_EQ(looks_at(10 * kMiB), 1);
  EXPECT_EQ(looks_at(50 * kMiB), 2);
}

}  // namespace
}  // namespace axisgate::server
