#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <string>

#include "device/link/low_latency.h"

namespace axisgate::link_test {
namespace {

namespace fs = std::filesystem;

// What the kernel shows of an adapter, and a link to it as /dev/serial/by-id has.
class LowLatencyTest : public testing::Test {
 protected:
  LowLatencyTest() {
    std::string name = (fs::temp_directory_path() / "axisgate-latency-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    std::ofstream(folder_ / "ttyUSB7");
    fs::create_symlink(folder_ / "ttyUSB7", folder_ / "stage");
  }
  ~LowLatencyTest() override { fs::remove_all(folder_); }

  void show_timer(const std::string& text) {
    fs::create_directories(folder_ / "classes" / "ttyUSB7" / "device");
    std::ofstream(folder_ / "classes" / "ttyUSB7" / "device" / "latency_timer") << text;
  }
  std::optional<std::string> ask() { return ask_for_low_latency(-1, folder_ / "stage", folder_ / "classes"); }

  fs::path folder_;
};

TEST_F(LowLatencyTest, AnAdapterThatHoldsBackIsNamedWithWhatEndsIt) {
  show_timer("16\n");
  const auto warning = ask();
  ASSERT_TRUE(warning);
  EXPECT_THAT(*warning, testing::HasSubstr((folder_ / "stage").string() + " holds replies back for up to 16 ms"));
  EXPECT_THAT(*warning, testing::HasSubstr("echo 1 > " + (folder_ / "classes/ttyUSB7/device/latency_timer").string()));
}

TEST_F(LowLatencyTest, OneThatPassesRepliesOnAtOnceIsNot) {
  show_timer("1\n");
  EXPECT_FALSE(ask());
}

TEST_F(LowLatencyTest, NorIsOneWithoutATimer) { EXPECT_FALSE(ask()); }

TEST_F(LowLatencyTest, NorIsAPortThatHasGone) {
  show_timer("16\n");
  fs::remove(folder_ / "ttyUSB7");
  EXPECT_FALSE(ask());
}

}  // namespace
}  // namespace axisgate::link_test
