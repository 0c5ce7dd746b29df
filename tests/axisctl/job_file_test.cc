// Tests of the reading of job files.
#include "clients/axisctl/mill/job_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>

#include "clients/axisctl/failure.h"
#include "tests/axisctl/scripted_mill.h"

namespace axisgate::axisctl {
namespace {

using ::testing::HasSubstr;

class JobFile : public MillVerbs {
 protected:
  JobFile() : name_(folder_ / "frame.rml") { std::ofstream(name_, std::ios::binary) << "^IN;PU0,0;"; }

  std::string why_refused(
      const std::string& name, std::int64_t most = 0,
      const std::function<void(std::string_view)>& take = [](std::string_view) {}) {
    try {
      read_job_file(name, most, take);
    } catch (const Failure& failure) {
      return failure.message;
    }
    return "";
  }

  const std::string name_;
};

TEST_F(JobFile, IsReadWhole) {
  std::string bytes;
  EXPECT_EQ(read_job_file(name_, 10, [&](std::string_view piece) { bytes += piece; }), 10);
  EXPECT_EQ(bytes, "^IN;PU0,0;");
}

// FIFOs and devices are refused, because reading them may never end.
TEST_F(JobFile, IsARegularFile) {
  const std::string fifo = folder_ / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  for (const std::string& name : {fifo, std::string("/dev/zero"), folder_.string()}) {
    EXPECT_THAT(why_refused(name), HasSubstr("is no regular file")) << name;
  }
  EXPECT_THAT(why_refused(folder_ / "missing.rml"), HasSubstr("missing.rml cannot be read: No such file"));
}

TEST_F(JobFile, IsRefusedByItsSizeBeforeItIsRead) {
  bool read = false;
  EXPECT_THAT(why_refused(name_, 9, [&](std::string_view) { read = true; }),
              HasSubstr("frame.rml has 10 bytes, and jobs of this mill have at most 9"));
  EXPECT_FALSE(read);
}

TEST_F(JobFile, IsRefusedIfItGrowsMeanwhile) {
  const auto grow = [&](std::string_view) { std::ofstream(name_, std::ios::app) << "PU9,9;"; };
  std::filesystem::resize_file(name_, 100'000);
  EXPECT_THAT(why_refused(name_, 0, grow), HasSubstr("was written to while it was read"));
}

// A missing file is reported without a call to the daemon.
TEST_F(JobFile, IsLookedAtBeforeTheDaemonIsAsked) {
  options_.job.files = {folder_ / "missing.rml"};
  EXPECT_EQ(run("mill send").exit_code, kUsage);
  EXPECT_TRUE(mill_.calls.empty());
  mill_.mill.set_job_bytes_at_most(9);
  options_.job.files = {name_};
  EXPECT_THAT(run("mill send").message, HasSubstr("has 10 bytes"));
  EXPECT_TRUE(mill_.sent.empty());
}

}  // namespace
}  // namespace axisgate::axisctl
