#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "device/link/low_latency.h"
#include "tests/unit/link/link_fixtures.h"

namespace axisgate::link_test {
namespace {

namespace fs = std::filesystem;

// The files that the kernel shows for an adapter, and a link to the adapter as in /dev/serial/by-id.
class LowLatencyTest : public testing::Test {
 protected:
  LowLatencyTest() {
    std::ofstream{tty_};
    fs::create_symlink(tty_, link_);
  }

  void show_timer(const std::string& text) {
    fs::create_directories(fs::path(timer_).parent_path());
    std::ofstream(timer_) << text;
  }
  std::optional<std::string> ask() { return ask_for_low_latency(-1, link_, directory_ / "classes"); }

  const TemporaryDirectory directory_;
  const std::string tty_ = directory_ / "ttyUSB7";
  const std::string link_ = directory_ / "stage";
  const std::string timer_ = directory_ / "classes/ttyUSB7/device/latency_timer";
};

TEST_F(LowLatencyTest, AnAdapterThatHoldsBackIsNamedWithWhatEndsIt) {
  show_timer("16\n");
  const auto warning = ask();
  ASSERT_TRUE(warning);
  EXPECT_THAT(*warning, testing::HasSubstr(link_ + " holds replies back for up to 16 ms"));
  EXPECT_THAT(*warning, testing::HasSubstr("echo 1 > " + timer_));
}

TEST_F(LowLatencyTest, OneThatPassesRepliesOnAtOnceIsNot) {
  show_timer("1\n");
  EXPECT_FALSE(ask());
}

TEST_F(LowLatencyTest, NorIsOneWithoutATimer) { EXPECT_FALSE(ask()); }

TEST_F(LowLatencyTest, NorIsAPortThatHasGone) {
  show_timer("16\n");
  fs::remove(tty_);
  EXPECT_FALSE(ask());
}

}  // namespace
}  // namespace axisgate::link_test
