#include "server/spare_memory.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <vector>

#include "server/events/timeouts.h"

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

// Without the setting, the first block raises the allocator's threshold when it is freed, and the second one comes from
// the heap. The blocks are larger than any that other tests of the program may have left free there, and smaller than
// the 32 MiB up to which the threshold rises.
TEST(LargeBlocks, AreTheSystems) {
  boost::asio::io_context never_runs;
  Timeouts timeouts(never_runs);
  keep_little_spare_memory(timeouts);
  const auto system = [] { return mallinfo2().hblkhd; };
  // The memory that earlier tests have left unused is not large enough for the block.
  const std::size_t block = 24 * kMiB + mallinfo2().fordblks;
  { const std::vector<char> first(block); }
  const std::size_t before = system();
  const std::vector<char> second(block);
  if (mallinfo2().arena == 0) GTEST_SKIP() << "another allocator is in its place";
  EXPECT_GE(system() - before, block);
}

}  // namespace
}  // namespace axisgate::server
