// The state directory: used by one daemon, and not writable by other users.
#include "server/access/state_directory.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>

namespace axisgate::server::state_directory_test {
namespace {

namespace fs = std::filesystem;

class StateDirectoryTest : public testing::Test {
 protected:
  StateDirectoryTest() : folder_(testing::TempDir() + "axisgate-state-" + std::to_string(::getpid())) {
    fs::remove_all(folder_);
  }
  ~StateDirectoryTest() override { fs::remove_all(folder_); }

  static std::string why(const std::string& folder) {
    const auto held = StateDirectory::hold(folder);
    return held ? "held" : held.error().message + "; " + held.error().hint;
  }
  std::string lock() const { return folder_ + "/lock"; }
  std::string held_by(const std::string& whom) const {
    return "the state directory " + folder_ + " is held by another axisgated" + whom +
           "; end the other one, or give this one a directory of its own with STATE_DIRECTORY";
  }

  const std::string folder_;
};

TEST_F(StateDirectoryTest, IsHeldByOneDaemonForItsLife) {
  std::optional first(StateDirectory::hold(folder_));
  ASSERT_TRUE(*first) << first->error().message;
  EXPECT_EQ((*first)->file("tokens"), folder_ + "/tokens");
  EXPECT_EQ(why(folder_), held_by(" (process " + std::to_string(::getpid()) + ")"));
  EXPECT_EQ(why(folder_), held_by(" (process " + std::to_string(::getpid()) + ")")) << "the name stays in the lock";
  first.reset();
  EXPECT_EQ(why(folder_), "held");
}

TEST_F(StateDirectoryTest, AHolderWithoutANameIsRespected) {
  fs::create_directory(folder_);
  const Descriptor other(::open(lock().c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  ASSERT_EQ(::flock(other.get(), LOCK_EX), 0);
  EXPECT_EQ(why(folder_), held_by(""));
}

TEST_F(StateDirectoryTest, TheLockOfAKilledDaemonIsNoHindrance) {
  fs::create_directory(folder_);
  std::ofstream(lock()) << "4194304000\n";
  const auto held = StateDirectory::hold(folder_);
  ASSERT_TRUE(held) << held.error().message;
  int process = 0;
  std::ifstream(lock()) >> process;
  EXPECT_EQ(process, ::getpid());
}

TEST_F(StateDirectoryTest, OthersMayNotWriteThere) {
  ASSERT_EQ(why(folder_), "held");
  ASSERT_EQ(::chmod(folder_.c_str(), 0777), 0);
  EXPECT_EQ(why(folder_),
            "the state directory " + folder_ +
                " may be written by everybody on this machine, who could change what the daemon does; chmod go-w " +
                folder_);
  ASSERT_EQ(::chmod(folder_.c_str(), 0755), 0);
  EXPECT_EQ(why(folder_), "held");
}

TEST_F(StateDirectoryTest, TheLockIsARegularFile) {
  fs::create_directory(folder_);
  ASSERT_EQ(::mkfifo(lock().c_str(), 0600), 0);
  EXPECT_EQ(why(folder_), lock() + " is a FIFO, not a regular file; move it away: the daemon makes this file itself");
  fs::remove(lock());
  fs::create_symlink(folder_ + "/victim", lock());
  EXPECT_NE(why(folder_), "held");
  EXPECT_FALSE(fs::exists(folder_ + "/victim"));
}

TEST_F(StateDirectoryTest, ALinkIsResolvedOnce) {
  fs::create_directories(folder_ + "/disk/state");
  fs::create_directory_symlink("disk", folder_ + "/link");
  for (const char* path : {"/link/state", "/link/state/"}) {
    const auto held = StateDirectory::hold(folder_ + path);
    ASSERT_TRUE(held) << held.error().message;
    EXPECT_EQ(held->path(), fs::canonical(folder_ + "/disk/state"));
  }
}

TEST_F(StateDirectoryTest, BehindALinkNobodyElseMayWriteAnyFolderOfTheRealPath) {
  fs::create_directories(folder_ + "/disk/deep/state");
  const std::string link = folder_ + "/link", real = folder_ + "/disk/deep/state";
  fs::create_directory_symlink(real, link);
  ASSERT_EQ(::chmod((folder_ + "/disk").c_str(), 0777), 0);
  EXPECT_EQ(why(link), "the state directory " + link + " is a link to " + real + ", and the folder " + folder_ +
                           "/disk may be written by everybody on this machine, who could change what the daemon "
                           "does; chmod go-w " +
                           folder_ + "/disk");
  ASSERT_EQ(::chmod((folder_ + "/disk").c_str(), 01777), 0);
  EXPECT_EQ(why(link), "held") << "in a sticky folder nobody else may rename what is there";
  ASSERT_EQ(::chmod(real.c_str(), 01777), 0);
  EXPECT_NE(why(link), "held") << "in the state directory itself everybody could make files first";
}

TEST_F(StateDirectoryTest, ALinkToNothingIsRefused) {
  fs::create_directory(folder_);
  fs::create_directory_symlink("gone", folder_ + "/link");
  EXPECT_EQ(why(folder_ + "/link"),
            "the state directory " + folder_ +
                "/link is a link to gone, which does not exist; "
                "make that directory or mount its disk, or set STATE_DIRECTORY to another path");
}

TEST_F(StateDirectoryTest, AFileIsNone) {
  std::ofstream(folder_) << "a file";
  EXPECT_EQ(why(folder_), "the state directory " + folder_ +
                              " is not a directory; move it away, or set STATE_DIRECTORY to another path");
}

// A daemon without the directory keeps nothing, and its log says so, because the generation cannot be written either.
TEST_F(StateDirectoryTest, WhatCannotBeMadeIsHeldByNobody) { EXPECT_EQ(why("/proc/axisgate"), "held"); }

}  // namespace
}  // namespace axisgate::server::state_directory_test
